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

// The folded runs of one cell in some replicates.
struct QuietRuns {
  std::uint64_t runs = 0, transports_done = 0;
  std::uint64_t in_safe_mode = 0;  // runs
  std::uint64_t simulated_ns = 0;  // of each run
  std::uint32_t agv_count = 0;     // of each run
  std::optional<std::int64_t> min_clearance_um;

  void add(const FoldedRun& run);  // one more, of the same time and as many AGVs
};
// Consecutive replicates of which all runs are folded: nothing went wrong in any of them, and none of their runs
// repeats an earlier one, as far as the file says.
struct QuietReplicates {
  std::uint64_t replicates = 0;
  std::vector<QuietRuns> by_cell;
};
using VisitQuiet = std::function<void(const QuietReplicates& quiet)>;

// What a file has at the place of a run. `known`: what is known of it (RunRecord::folded); nothing if it was kept.
struct FoldedPlace {
  std::optional<RunRecord> known;
  bool repeats = false;  // an earlier run of its cell had the same trace
};

// The folded rows of a file of this schema, in order of run index. Its functions throw BrokenFold and
// SQLite::Exception. Threads: one.
class FoldedRows {
 public:
  // `cells` and `visit_met` outlive the object. Visits what a block met when its first run is asked for.
  FoldedRows(SQLite::Database& db, std::int32_t schema, const std::vector<CellRecord>& cells,
             const VisitMet& visit_met);
  ~FoldedRows();
  FoldedRows(const FoldedRows&) = delete;
  FoldedRows& operator=(const FoldedRows&) = delete;

  // Ask for all runs, in order of run index.
  FoldedPlace next(std::uint64_t run_index);
  // Instead, for whole replicates: as many as follow from this run on, perhaps none. Requires: it is the first of its
  // replicate.
  QuietReplicates skip_quiet(std::uint64_t run_index);
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
std::optional<KnownRun> find_folded(SQLite::Database& db, std::int32_t schema, const std::vector<CellRecord>& cells,
                                    std::uint64_t run_index);

}  // namespace fleetproof
