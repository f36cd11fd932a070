#pragma once

#include <memory>
#include <string>

struct sqlite3_stmt;

namespace SQLite {
class Database;
}

namespace fleetproof {

// A statement of SQLite, for the classes that call its C interface row by row. Requires: the database outlives it.
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

}  // namespace fleetproof
