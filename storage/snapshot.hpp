#pragma once

namespace SQLite {
class Database;
}

namespace fleetproof {

// All statements see one state of the file, even while a campaign writes it. A snapshot inside a snapshot is the same
// state.
class Snapshot {
 public:
  explicit Snapshot(SQLite::Database& db);
  ~Snapshot();
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

 private:
  SQLite::Database& db_;
  bool outermost_;
};

}  // namespace fleetproof
