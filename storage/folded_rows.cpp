#include "storage/folded_rows.hpp"

#include <SQLiteCpp/Database.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "storage/checksum.hpp"
#include "storage/rows.hpp"
#include "storage/schema.hpp"
#include "storage/statement.hpp"

namespace fleetproof {
namespace {

FoldEncoding encoding_of(std::int32_t schema) {
  return schema < kFirstJudged ? FoldEncoding::WithoutRepeats : FoldEncoding::WithRepeats;
}

std::string name_of_row(const FoldedRow& row) { return fmt::format("the folded runs {}", row.place); }

// A row and its checksum, which was right.
std::pair<FoldedRow, std::uint64_t> sound_row(const Query& statement) {
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
  known.repeats = run.repeats;
  known.folded = true;
  return known;
}

}  // namespace

void QuietRuns::add(const FoldedRun& run) {
  ++runs;
  transports_done += run.transports_done;
  in_safe_mode += run.safe_mode_ns > 0 ? 1 : 0;
  if (run.min_clearance_um)
    min_clearance_um = std::min(min_clearance_um.value_or(*run.min_clearance_um), *run.min_clearance_um);
}

struct FoldedRows::Impl {
  // The folded runs of one cell in the block that is read.
  struct Open {
    FoldedRow row;
    UnfoldedCell runs;
  };

  const std::int32_t schema;
  const std::vector<CellRecord>& cells;
  const VisitMet& visit_met;
  Query rows;
  bool more;
  std::vector<std::optional<Open>> block;  // by cell
  std::optional<std::uint64_t> open_number;
  RowsDigest digest;

  Impl(SQLite::Database& db, std::int32_t of_schema, const std::vector<CellRecord>& of, const VisitMet& visit)
      : schema(of_schema),
        cells(of),
        visit_met(visit),
        rows(db, fmt::format("SELECT {} FROM folded ORDER BY place", kFoldedColumns)),
        more(rows.step()),
        block(of.size()) {}

  void close_block() {
    for (auto& open : block) {
      if (open && !open->runs.at_end()) throw BrokenFold(name_of_row(open->row) + " are more than the file has");
      open.reset();
    }
  }

  void open_block(std::uint64_t number) {
    if (open_number == number) return;
    close_block();
    open_number = number;
    for (; more; more = rows.step()) {
      auto [row, checksum] = sound_row(rows);
      if (row.place / cells.size() > number) break;
      if (row.place / cells.size() < number || row.place % cells.size() != row.cell || block[row.cell])
        throw BrokenFold(name_of_row(row) + " belong to no runs of the file");
      digest.add(checksum);
      UnfoldedCell runs(row.content, encoding_of(schema));
      if (visit_met) visit_met(row.cell, runs.met());
      const std::uint32_t cell = row.cell;
      block[cell].emplace(Open{std::move(row), std::move(runs)});
    }
  }
};

FoldedRows::FoldedRows(SQLite::Database& db, std::int32_t schema, const std::vector<CellRecord>& cells,
                       const VisitMet& visit_met)
    : impl_(std::make_unique<Impl>(db, schema, cells, visit_met)) {}
FoldedRows::~FoldedRows() = default;

FoldedPlace FoldedRows::next(std::uint64_t run_index) {
  const std::uint64_t replicate = run_index / impl_->cells.size(), cell = run_index % impl_->cells.size();
  if (cell == 0 && replicate % kReplicatesPerFold == 0) impl_->open_block(replicate / kReplicatesPerFold);
  auto& open = impl_->block[cell];
  if (!open) return {};
  const auto [run, repeats] = open->runs.next();
  if (!run) return {std::nullopt, repeats};
  return {known_of(*run, impl_->cells[cell], replicate, run_index, open->row), repeats};
}

QuietReplicates FoldedRows::skip_quiet(std::uint64_t run_index) {
  const std::uint64_t replicate = run_index / impl_->cells.size();
  impl_->open_block(replicate / kReplicatesPerFold);
  auto& block = impl_->block;
  QuietReplicates quiet;
  const auto is_quiet = [](const auto& open) { return open && open->runs.next_is_folded_and_new(); };
  for (std::uint64_t left = kReplicatesPerFold - replicate % kReplicatesPerFold;
       left > 0 && std::ranges::all_of(block, is_quiet); --left) {
    quiet.by_cell.resize(block.size());
    for (std::size_t cell = 0; cell < block.size(); ++cell) quiet.by_cell[cell].add(*block[cell]->runs.next().run);
    ++quiet.replicates;
  }
  for (std::size_t cell = 0; cell < quiet.by_cell.size(); ++cell) {
    quiet.by_cell[cell].simulated_ns = block[cell]->row.simulated_ns;
    quiet.by_cell[cell].agv_count = block[cell]->row.agv_count;
  }
  return quiet;
}

std::uint64_t FoldedRows::digest() {
  impl_->close_block();
  if (impl_->more) throw BrokenFold(name_of_row(sound_row(impl_->rows).first) + " belong to no runs of the file");
  return impl_->digest.value();
}

std::optional<KnownRun> find_folded(SQLite::Database& db, std::int32_t schema, const std::vector<CellRecord>& cells,
                                    std::uint64_t run_index) {
  const std::uint64_t replicate = run_index / cells.size(), cell = run_index % cells.size();
  Query rows(db, fmt::format("SELECT {} FROM folded WHERE place = ?", kFoldedColumns));
  rows.bind(1, static_cast<std::int64_t>(replicate / kReplicatesPerFold * cells.size() + cell));
  if (!rows.step()) return std::nullopt;
  const FoldedRow row = sound_row(rows).first;
  UnfoldedCell runs(row.content, encoding_of(schema));
  for (std::uint64_t before = replicate % kReplicatesPerFold; before > 0; --before) (void)runs.next();
  const auto run = runs.next().run;
  if (!run) return std::nullopt;
  return KnownRun{known_of(*run, cells[cell], replicate, run_index, row), run->check};
}

}  // namespace fleetproof
