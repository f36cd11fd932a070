#include "storage/fold.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>

#include <algorithm>
#include <bit>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "storage/archive_reader.hpp"
#include "storage/checksum.hpp"
#include "storage/folded_cell.hpp"
#include "storage/rows.hpp"
#include "storage/schema.hpp"
#include "storage/statement.hpp"

namespace fleetproof {
namespace {

std::set<std::uint64_t> runs_with_more(SQLite::Database& db) {
  std::set<std::uint64_t> runs;
  SQLite::Statement rows(db,
                         "SELECT run_index FROM live.recordings UNION SELECT a.run_index FROM live.audits a JOIN "
                         "live.runs r ON r.run_index = a.run_index WHERE a.checksum <> r.checksum");
  while (rows.executeStep()) runs.insert(unsigned_of(rows, 0));
  return runs;
}

FoldedRow row_of(const FoldedCell& cell, std::uint64_t place, std::uint32_t index) {
  return {place,
          index,
          cell.runs(),
          cell.transports_done(),
          cell.simulated_ns(),
          cell.agv_count(),
          cell.min_clearance_um(),
          cell.content()};
}

class Folder {
 public:
  Folder(SQLite::Database& db, const std::vector<CellRecord>& cells, const MayFold& may_fold)
      : may_fold_(may_fold),
        cells_(cells),
        more_(runs_with_more(db)),
        insert_folded_(insert_into(db, "main.folded", kFoldedColumns)),
        insert_kept_(insert_into(db, "temp.kept", "run_index")),
        block_(cells.size()) {}

  void add(const RunRecord& run) {
    repeated_traces_ += run.repeats ? 1 : 0;
    FoldedCell& cell = block_[run.cell];
    if (is_folded(run, cell)) {
      cell.fold(run, row_checksum(run));
    } else {
      cell.keep(run.repeats);
      insert_kept_.bind(1, std::bit_cast<std::int64_t>(run.run_index));
      insert_kept_.run();
    }
    const bool ends_replicate = run.cell + 1 == cells_.size();
    if (ends_replicate && (run.replicate + 1) % kReplicatesPerFold == 0) end_block();
  }

  std::uint64_t repeated_traces() const { return repeated_traces_; }

  void end_block() {
    for (std::size_t cell = 0; cell < block_.size(); ++cell) {
      if (block_[cell].says_nothing()) continue;
      const FoldedRow row =
          row_of(block_[cell], block_number_ * block_.size() + cell, static_cast<std::uint32_t>(cell));
      bind_folded(insert_folded_, row, folded_checksum(row));
      insert_folded_.run();
    }
    ++block_number_;
    block_.assign(cells_.size(), FoldedCell());
  }

 private:
  bool is_folded(const RunRecord& run, const FoldedCell& cell) {
    const bool is_first = meets_something_new(run);
    return !is_first && may_fold_(run) && cell.suits(run.outcome) && run.outcome.min_clearance_um.value_or(0) >= 0 &&
           !more_.contains(run.run_index);
  }

  bool meets_something_new(const RunRecord& run) {
    bool is_new = false;
    for (const ProbeCount& probe : run.outcome.probes)
      is_new |= met_.emplace(cells_[run.cell].agent, probe.source, probe.name).second;
    if (run.outcome.counters.safe_mode_ns > 0) is_new |= in_safe_mode_.insert(cells_[run.cell].agent).second;
    return is_new;
  }

  const MayFold& may_fold_;
  const std::vector<CellRecord>& cells_;
  std::set<std::uint64_t> more_;
  std::set<std::tuple<std::string, ProbeSource, std::string>> met_;
  std::set<std::string> in_safe_mode_;
  Insert insert_folded_, insert_kept_;
  std::uint64_t block_number_ = 0, repeated_traces_ = 0;
  std::vector<FoldedCell> block_;  // by cell
};

}  // namespace

std::uint64_t fold_runs(SQLite::Database& db, const std::string& live_path, const MayFold& may_fold) {
  db.exec("CREATE TEMP TABLE kept (run_index INTEGER PRIMARY KEY)");
  const ArchiveReader live(live_path);
  Folder folder(db, live.cells(), may_fold);
  live.for_each_run([&](const RunRecord& run) { folder.add(run); });
  folder.end_block();
  return folder.repeated_traces();
}

}  // namespace fleetproof
