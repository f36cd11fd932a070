#include "storage/snapshot.hpp"

#include <SQLiteCpp/Database.h>
#include <sqlite3.h>

namespace fleetproof {

Snapshot::Snapshot(SQLite::Database& db) : db_(db), outermost_(sqlite3_get_autocommit(db.getHandle()) != 0) {
  if (outermost_) db_.exec("BEGIN");
}

Snapshot::~Snapshot() {
  if (outermost_) db_.tryExec("ROLLBACK");
}

}  // namespace fleetproof
