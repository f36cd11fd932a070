#include "storage/insert.hpp"

#include <SQLiteCpp/Database.h>
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
