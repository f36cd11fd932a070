#pragma once

#include <cstdint>
#include <memory>

#include "storage/records.hpp"

namespace SQLite {
class Database;
}

namespace fleetproof {

// Stores runs with all their parts, and audits, in an open live file. Its statements are prepared once. Throws
// SQLite::Exception. Threads: one.
class RowStore {
 public:
  // The database outlives the object.
  explicit RowStore(SQLite::Database& db);
  ~RowStore();
  RowStore(const RowStore&) = delete;
  RowStore& operator=(const RowStore&) = delete;

  // A run that is there already stays as it is. False: it is there with another outcome.
  bool add(const RunRecord& run);
  void add(const AuditRecord& audit);

 private:
  struct Statements;
  std::unique_ptr<Statements> statements_;
};

}  // namespace fleetproof
