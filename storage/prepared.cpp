#include "storage/prepared.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>
#include <sqlite3.h>

namespace fleetproof {

void Prepared::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Prepared::Prepared(SQLite::Database& db, const std::string& sql) : db_(&db) {
  sqlite3_stmt* statement = nullptr;
  require(sqlite3_prepare_v3(db.getHandle(), sql.c_str(), static_cast<int>(sql.size()) + 1, SQLITE_PREPARE_PERSISTENT,
                             &statement, nullptr));
  statement_.reset(statement);
}

void Prepared::require(int code) const {
  if (code != SQLITE_OK) throw SQLite::Exception(db_->getHandle(), code);
}

}  // namespace fleetproof
