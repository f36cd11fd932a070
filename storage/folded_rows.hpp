#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "storage/folded_cell.hpp"
#include "storage/records.hpp"

namespace SQLite {
class Database;
}

namespace fleetproof {

// What folded runs of a cell met, all of one block of replicates.
using VisitMet = std::function<void(std::uint32_t cell, const std::vector<MetTotal>& met)>;

// The folded rows of a file, in order of run index. Its functions throw BrokenFold and SQLite::Exception. Threads: one.
class FoldedRows {
 public:
  // `cells` and `visit_met` outlive the object. Visits what a block met when its first run is asked for.
  FoldedRows(SQLite::Database& db, const std::vector<CellRecord>& cells, const VisitMet& visit_met);
  ~FoldedRows();
  FoldedRows(const FoldedRows&) = delete;
  FoldedRows& operator=(const FoldedRows&) = delete;

  // What is known of the run (RunRecord::folded); nothing if it was kept. Ask for all runs, in order of run index.
  std::optional<RunRecord> next(std::uint64_t run_index);
  // Of all rows. Throws if a row has not been asked for to its end.
  std::uint64_t digest();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// What is known of one run, and the lowest bits of its checksum; nothing if it was not folded.
struct KnownRun {
  RunRecord run;
  std::uint16_t check = 0;
};
std::optional<KnownRun> find_folded(SQLite::Database& db, const std::vector<CellRecord>& cells,
                                    std::uint64_t run_index);

}  // namespace fleetproof
