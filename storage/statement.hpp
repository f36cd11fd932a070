#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "storage/row_source.hpp"

struct sqlite3_stmt;

namespace SQLite {
class Database;
}

namespace fleetproof {

// Statements of SQLite, by its C interface: what they have in common, a SELECT, an INSERT.

// A prepared statement, for the classes that call its C interface row by row. Requires: the database outlives it.
class Prepared {
 public:
  // Throws SQLite::Exception if this is no statement for the database.
  Prepared(SQLite::Database& db, const std::string& sql);

  sqlite3_stmt* get() const { return statement_.get(); }
  SQLite::Database& database() const { return *db_; }
  // Throws SQLite::Exception unless a call returned SQLITE_OK.
  void require(int code) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };

  SQLite::Database* db_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

// A SELECT under way. Its functions throw SQLite::Exception. Requires: the database outlives the query.
class Query final : public RowSource {
 public:
  Query(SQLite::Database& db, const std::string& select);

  void bind(int parameter, std::int64_t value);
  void bind(int parameter, const std::string& text);

  bool step() override;
  std::int64_t number(int column) const override;
  double real(int column) const override;
  std::string_view bytes(int column) const override;
  bool is_null(int column) const override;
  int column_of(const char* name) const;
  int column_count() const;

 private:
  Prepared statement_;
};

// An INSERT, prepared once and run for many rows. Parameters count from 1. Its functions throw SQLite::Exception.
// Requires: the database outlives the object.
class Insert {
 public:
  // Whose memory holds a text until `run`: the caller's, or a copy.
  enum class Kept : std::uint8_t { ByCaller, AsCopy };

  Insert(SQLite::Database& db, const std::string& sql);

  void bind(int parameter, std::int64_t value);
  void bind(int parameter, double value);  // requires: not NaN
  void bind_text(int parameter, std::string_view text, Kept kept = Kept::ByCaller);
  void bind_bytes(int parameter, std::string_view bytes, Kept kept = Kept::ByCaller);
  void bind_null(int parameter);
  // Returns the number of rows that it inserted.
  int run();

 private:
  Prepared statement_;
};

// Into `table`, one row. `columns`: names with commas between.
Insert insert_into(SQLite::Database& db, const std::string& table, const std::string& columns);

}  // namespace fleetproof
