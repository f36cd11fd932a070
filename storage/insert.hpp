#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "storage/prepared.hpp"

namespace SQLite {
class Database;
}

namespace fleetproof {

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
