#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace SQLite {
class Database;
}

namespace fleetproof {

// Throws InputError, with a remedy, if there is no file of this name or it may not be read.
void require_readable(const std::string& path);

// A results file, opened for reading only.
struct OpenedFile {
  std::unique_ptr<SQLite::Database> db;
  std::int32_t schema = 0;  // one that this program reads
  bool published = false;   // not a live file
};

// Each table that this program reads is a table, with the columns of its schema. Views are never read, triggers and
// functions of others never run, and a query that takes too many steps from one row to the next ends with an exception.
// Throws InputError if the file is not a results file, if its schema is newer or too old, if a view or a generated
// column takes the place of stored values, or if a journal of another file stands beside it. Throws EngineError if it
// is damaged, SQLite::Exception if SQLite cannot read it.
// Requires: require_readable.
OpenedFile open_to_read(const std::string& path);

// All tables and views of the file, as it defines them.
std::string schema_text(SQLite::Database& db);

[[noreturn]] void throw_damaged(const std::string& path, const std::string& what);

}  // namespace fleetproof
