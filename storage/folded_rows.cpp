#include "storage/folded_rows.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <bit>
#include <utility>

#include "storage/checksum.hpp"
#include "storage/rows.hpp"
#include "storage/schema.hpp"

namespace fleetproof {
namespace {

std::string name_of_row(const FoldedRow& row) { return fmt::format("the folded runs {}", row.place); }

// A row and its checksum, which was right.
std::pair<FoldedRow, std::uint64_t> sound_row(const SQLite::Statement& statement) {
  auto found = read_folded(statement);
  if (folded_checksum(found.first) != found.second)
    throw BrokenFold(fmt::format("{} do not match their checksum", name_of_row(found.first)));
  return found;
}

RunRecord known_of(const FoldedRun& run, const CellRecord& cell, std::uint64_t replicate, std::uint64_t run_index,
                   const FoldedRow& row) {
  RunRecord known;
  known.run_index = run_index;
  known.cell = cell.index;
  known.replicate = replicate;
  known.factors = run.in_contract ? cell.lowest : cell.highest;
  known.outcome.min_clearance_um = run.min_clearance_um;
  known.outcome.simulated_ns = row.simulated_ns;
  known.outcome.agv_count = row.agv_count;
  known.outcome.counters.transports_done = run.transports_done;
  known.outcome.counters.safe_mode_ns = run.safe_mode_ns;
  known.folded = true;
  return known;
}

}  // namespace

struct FoldedRows::Impl {
  // The folded runs of one cell in the block that is read.
  struct Open {
    FoldedRow row;
    UnfoldedCell runs;
  };

  const std::vector<CellRecord>& cells;
  const VisitMet& visit_met;
  SQLite::Statement rows;
  bool more;
  std::vector<std::optional<Open>> block;  // by cell
  RowsDigest digest;

  Impl(SQLite::Database& db, const std::vector<CellRecord>& of, const VisitMet& visit)
      : cells(of),
        visit_met(visit),
        rows(db, fmt::format("SELECT {} FROM folded ORDER BY place", kFoldedColumns)),
        more(rows.executeStep()),
        block(of.size()) {}

  void close_block() {
    for (auto& open : block) {
      if (open && !open->runs.at_end()) throw BrokenFold(name_of_row(open->row) + " are more than the file has");
      open.reset();
    }
  }

  void open_block(std::uint64_t number) {
    close_block();
    for (; more; more = rows.executeStep()) {
      auto [row, checksum] = sound_row(rows);
      if (row.place / cells.size() > number) break;
      if (row.place / cells.size() < number || row.place % cells.size() != row.cell || block[row.cell])
        throw BrokenFold(name_of_row(row) + " belong to no runs of the file");
      digest.add(checksum);
      UnfoldedCell runs(row.content);
      if (visit_met) visit_met(row.cell, runs.met());
      const std::uint32_t cell = row.cell;
      block[cell].emplace(Open{std::move(row), std::move(runs)});
    }
  }
};

FoldedRows::FoldedRows(SQLite::Database& db, const std::vector<CellRecord>& cells, const VisitMet& visit_met)
    : impl_(std::make_unique<Impl>(db, cells, visit_met)) {}
FoldedRows::~FoldedRows() = default;

std::optional<RunRecord> FoldedRows::next(std::uint64_t run_index) {
  const std::uint64_t replicate = run_index / impl_->cells.size(), cell = run_index % impl_->cells.size();
  if (cell == 0 && replicate % kReplicatesPerFold == 0) impl_->open_block(replicate / kReplicatesPerFold);
  auto& open = impl_->block[cell];
  if (!open) return std::nullopt;
  const auto run = open->runs.next();
  if (!run) return std::nullopt;
  return known_of(*run, impl_->cells[cell], replicate, run_index, open->row);
}

std::uint64_t FoldedRows::digest() {
  impl_->close_block();
  if (impl_->more) throw BrokenFold(name_of_row(sound_row(impl_->rows).first) + " belong to no runs of the file");
  return impl_->digest.value();
}

std::optional<KnownRun> find_folded(SQLite::Database& db, const std::vector<CellRecord>& cells,
                                    std::uint64_t run_index) {
  const std::uint64_t replicate = run_index / cells.size(), cell = run_index % cells.size();
  SQLite::Statement rows(db, fmt::format("SELECT {} FROM folded WHERE place = ?", kFoldedColumns));
  rows.bind(1, static_cast<std::int64_t>(replicate / kReplicatesPerFold * cells.size() + cell));
  if (!rows.executeStep()) return std::nullopt;
  const FoldedRow row = sound_row(rows).first;
  UnfoldedCell runs(row.content);
  for (std::uint64_t before = replicate % kReplicatesPerFold; before > 0; --before) (void)runs.next();
  const auto run = runs.next();
  if (!run) return std::nullopt;
  return KnownRun{known_of(*run, cells[cell], replicate, run_index, row), run->check};
}

}  // namespace fleetproof
