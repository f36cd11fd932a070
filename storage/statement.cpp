#include "storage/statement.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <cmath>

#include "core/base/error.hpp"
#include "storage/schema.hpp"

namespace fleetproof {
namespace {

sqlite3_destructor_type holder(Insert::Kept kept) {
  return kept == Insert::Kept::AsCopy ? SQLITE_TRANSIENT : SQLITE_STATIC;
}

}  // namespace

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

Query::Query(SQLite::Database& db, const std::string& select) : statement_(db, select) {}

void Query::bind(int parameter, std::int64_t value) {
  statement_.require(sqlite3_bind_int64(statement_.get(), parameter, value));
}

void Query::bind(int parameter, const std::string& text) {
  statement_.require(
      sqlite3_bind_text(statement_.get(), parameter, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
}

bool Query::step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) statement_.require(code);
  sqlite3_stmt_status(statement_.get(), SQLITE_STMTSTATUS_VM_STEP, 1);  // the limit of steps holds from row to row
  return code == SQLITE_ROW;
}

std::int64_t Query::number(int column) const { return sqlite3_column_int64(statement_.get(), column); }
double Query::real(int column) const { return sqlite3_column_double(statement_.get(), column); }
bool Query::is_null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }

std::string_view Query::bytes(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

int Query::column_count() const { return sqlite3_column_count(statement_.get()); }

int Query::column_of(const char* name) const {
  for (int column = 0; column < column_count(); ++column) {
    if (std::string_view(sqlite3_column_name(statement_.get(), column)) == name) return column;
  }
  invariant_violated("a query has the column that it is asked for");
}

Insert::Insert(SQLite::Database& db, const std::string& sql) : statement_(db, sql) {}

void Insert::bind(int parameter, std::int64_t value) {
  statement_.require(sqlite3_bind_int64(statement_.get(), parameter, value));
}
void Insert::bind(int parameter, double value) {
  ensure(!std::isnan(value), "a stored value is a number: SQLite would store NULL");
  statement_.require(sqlite3_bind_double(statement_.get(), parameter, value));
}
void Insert::bind_null(int parameter) { statement_.require(sqlite3_bind_null(statement_.get(), parameter)); }

void Insert::bind_text(int parameter, std::string_view text, Kept kept) {
  statement_.require(
      sqlite3_bind_text(statement_.get(), parameter, text.data(), static_cast<int>(text.size()), holder(kept)));
}

void Insert::bind_bytes(int parameter, std::string_view bytes, Kept kept) {
  const char* data = bytes.data() != nullptr ? bytes.data() : "";  // a null address would be stored as NULL
  statement_.require(
      sqlite3_bind_blob(statement_.get(), parameter, data, static_cast<int>(bytes.size()), holder(kept)));
}

int Insert::run() {
  const int code = sqlite3_step(statement_.get());
  sqlite3_reset(statement_.get());  // ends the statement, so that the values of the next row can be bound
  if (code != SQLITE_DONE) statement_.require(code);
  return sqlite3_changes(statement_.database().getHandle());
}

Insert insert_into(SQLite::Database& db, const std::string& table, const std::string& columns) {
  return {db, fmt::format("INSERT INTO {} ({}) VALUES ({})", table, columns, placeholders(columns))};
}

}  // namespace fleetproof
