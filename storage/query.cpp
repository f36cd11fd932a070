#include "storage/query.hpp"

#include <SQLiteCpp/Database.h>
#include <sqlite3.h>

#include "core/base/error.hpp"

namespace fleetproof {

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
  return code == SQLITE_ROW;
}

std::int64_t Query::number(int column) const { return sqlite3_column_int64(statement_.get(), column); }
double Query::real(int column) const { return sqlite3_column_double(statement_.get(), column); }
bool Query::is_null(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }

std::string_view Query::bytes(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

int Query::column_of(const char* name) const {
  const int columns = sqlite3_column_count(statement_.get());
  for (int column = 0; column < columns; ++column) {
    if (std::string_view(sqlite3_column_name(statement_.get(), column)) == name) return column;
  }
  invariant_violated("a query has the column that it is asked for");
}

}  // namespace fleetproof
