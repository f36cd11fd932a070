#include "storage/archive_reader.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <bit>

#include "core/base/error.hpp"
#include "core/outcome/run_result.hpp"
#include "storage/checksum.hpp"
#include "storage/opened_file.hpp"
#include "storage/plan_rows.hpp"
#include "storage/rows.hpp"
#include "storage/schema.hpp"
#include "storage/seen_traces.hpp"
#include "storage/sqlite_errors.hpp"
#include "storage/statement.hpp"
#include "storage/table_pages.hpp"

namespace fleetproof {
namespace {

std::uint64_t run_of(const Row& part) { return std::bit_cast<std::uint64_t>(part.number(0)); }

std::optional<std::uint64_t> maybe(const Query& row, const char* name) {
  const int column = row.column_of(name);
  return row.is_null(column) ? std::nullopt : std::optional(std::bit_cast<std::uint64_t>(row.number(column)));
}

// All statements see one state of the file, even while a campaign writes it. A snapshot inside a snapshot is the same
// state.
class Snapshot {
 public:
  explicit Snapshot(SQLite::Database& db) : db_(db), outermost_(sqlite3_get_autocommit(db.getHandle()) != 0) {
    if (outermost_) db_.exec("BEGIN");
  }
  ~Snapshot() {
    if (outermost_) db_.tryExec("ROLLBACK");
  }
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

 private:
  SQLite::Database& db_;
  bool outermost_;
};

// A table that holds parts of runs, by run and ordinal.
struct PartTable {
  const char* name;
  std::string (*values)(std::int32_t schema);  // its columns, to be read from a file of this schema
  // Parts of the run that the outcome held before are overwritten: their memory is used again.
  void (*take)(const Row& row, Outcome& outcome, std::size_t ordinal);
  void (*cut)(Outcome& outcome, std::size_t count);  // leaves out what another run has
};

template <class Part>
Part& part_at(std::vector<Part>& parts, std::size_t ordinal) {
  return ordinal < parts.size() ? parts[ordinal] : parts.emplace_back();
}

const std::array<PartTable, 3>& part_tables() {
  static const std::array<PartTable, 3> tables{{
      {"violations", violation_values,
       [](const Row& row, Outcome& o, std::size_t i) { part_at(o.violations, i) = read_violation(row); },
       [](Outcome& o, std::size_t count) { o.violations.resize(count); }},
      {"incidents", [](std::int32_t) { return std::string(kIncidentColumns); },
       [](const Row& row, Outcome& o, std::size_t i) { part_at(o.incidents, i) = read_incident(row); },
       [](Outcome& o, std::size_t count) { o.incidents.resize(count); }},
      {"probes", [](std::int32_t) { return std::string(kProbeColumns); },
       [](const Row& row, Outcome& o, std::size_t i) { read_probe(row, part_at(o.probes, i)); },
       [](Outcome& o, std::size_t count) { o.probes.resize(count); }},
  }};
  return tables;
}

}  // namespace

struct ArchiveReader::Impl {
  std::string path;
  Checksums checksums = Checksums::Verify;
  mutable std::unique_ptr<SQLite::Database> db;
  StoredPlan plan;
  std::uint64_t stored_checksum = 0;  // of the plan
  std::int32_t schema = kSchemaVersion;
  bool published = false;
  std::optional<std::uint64_t> sealed_count, seal;  // absent in a live file
  std::optional<FoldedContent> fold;                // absent if all runs have rows

  void open();
  void read_plan();
  void take_run(const Row& row, StoredRun& stored) const;
  void take_part(const PartTable& table, const Row& row, StoredRun& stored, std::size_t ordinal) const;
  void verify(const StoredRun& stored) const;
  void require_sealed(std::uint64_t count, const RowsDigest& rows, SealedContent& content) const;
  std::vector<ChunkRecord> stored_chunks() const;
  void require_content(std::uint64_t count, std::uint64_t content) const;
  void add_rest(SealedContent& content) const;
  std::uint64_t read_all(const VisitRun& visit, const VisitFolded& visit_folded = {}) const;
  std::uint64_t read_rows(const VisitRun& visit) const;
  class Rows;
  std::unique_ptr<RowSource> rows_of(const char* table, const std::string& values, const char* key) const;
  std::uint64_t read_folded_file(const VisitRun& visit, const VisitFolded& visit_folded) const;

  // Turns errors of SQLite into errors of this program.
  template <class Action>
  auto guarded(Action action) const {
    try {
      return action();
    } catch (const SQLite::Exception&) {
      throw_archive_error(path);
    }
  }
  [[noreturn]] void damaged(const std::string& what) const { throw_damaged(path, what); }
};

void ArchiveReader::Impl::open() {
  require_readable(path);
  auto file = guarded([&] { return open_to_read(path); });
  db = std::move(file.db);
  schema = file.schema;
  published = file.published;
  guarded([&] {
    const Snapshot snapshot(*db);
    read_plan();
  });
}

void ArchiveReader::Impl::read_plan() {
  const char* const fold_values = schema < kFirstFolded ? "NULL AS all_rows, NULL AS repeated"
                                                        : "rows_digest AS all_rows, repeated_traces AS repeated";
  Query row(*db, fmt::format("SELECT {}, run_count, {}, {} AS seal FROM campaign", campaign_values(schema), fold_values,
                             schema < kFirstSealed ? "rows_digest" : "seal"));
  if (!row.step()) damaged("it holds no plan");
  plan.campaign = read_campaign(row);
  if (plan.campaign.chunk_runs == 0) damaged("its chunks have no runs");
  stored_checksum = read_plan_checksum(row);
  sealed_count = maybe(row, "run_count");
  if (const auto all_rows = maybe(row, "all_rows")) fold = {0, *all_rows, maybe(row, "repeated").value_or(0), 0, 0};
  seal = maybe(row, "seal");
  if (published && !(sealed_count && seal)) damaged("it was published, but has no seal");
  Query cell_rows(*db, fmt::format("SELECT {} FROM cells ORDER BY cell", cell_values(schema)));
  while (cell_rows.step()) plan.cells.push_back(read_cell(cell_rows));
  Query gate_rows(*db, fmt::format("SELECT {} FROM gates ORDER BY gate", gate_values(schema)));
  while (gate_rows.step()) plan.gates.push_back(read_gate(gate_rows));
  if (checksums == Checksums::Verify && plan_checksum(plan, schema) != stored_checksum)
    damaged("its plan (campaign, cells, gates) does not match its checksum");
}

void ArchiveReader::Impl::take_run(const Row& row, StoredRun& stored) const {
  try {
    read_run(row, stored);
  } catch (const EngineError& e) {
    damaged(fmt::format("run {}: {}", row.number(0), e.what()));
  }
}

void ArchiveReader::Impl::take_part(const PartTable& table, const Row& row, StoredRun& stored,
                                    std::size_t ordinal) const {
  try {
    table.take(row, stored.run.outcome, ordinal);
  } catch (const EngineError& e) {
    damaged(fmt::format("{} of run {}: {}", table.name, stored.run.run_index, e.what()));
  }
}

void ArchiveReader::Impl::verify(const StoredRun& stored) const {
  const auto& run = stored.run;
  // Every reader of a run looks up its cell. The cell must therefore exist, even if checksums are ignored.
  if (run.cell >= plan.cells.size()) damaged(fmt::format("run {} belongs to no cell of the plan", run.run_index));
  if (checksums == Checksums::Ignore) return;
  const bool sound = row_checksum(run, schema) == stored.checksum &&
                     stored.outcome_class == name_of(run.outcome.outcome_class()) &&
                     run.run_index == run.replicate * plan.cells.size() + run.cell;
  if (!sound) damaged(fmt::format("run {} does not match its checksum", run.run_index));
  if (schema >= kFirstJudged && stored.judged != judged(run.outcome))
    damaged(fmt::format("the end points of run {} are not those of its outcome", run.run_index));
}

std::vector<ChunkRecord> ArchiveReader::Impl::stored_chunks() const {
  std::vector<ChunkRecord> stored;
  Query rows(*db, fmt::format("SELECT {} FROM chunks ORDER BY chunk", kChunkColumns));
  while (rows.step()) stored.push_back(read_chunk(rows));
  return stored;
}

void ArchiveReader::Impl::add_rest(SealedContent& content) const {
  try {
    content.add_rest(*db, schema);
  } catch (const EngineError& e) {
    damaged(e.what());
  }
}

void ArchiveReader::Impl::require_content(std::uint64_t count, std::uint64_t content) const {
  if (count != *sealed_count) damaged(fmt::format("it was published with {} runs and holds {}", *sealed_count, count));
  if (schema >= kFirstSealed) content = seal_of(schema_text(*db), stored_checksum, count, content);
  if (content != seal) damaged("its tables, views, plan or runs are not those that were published");
}

void ArchiveReader::Impl::require_sealed(std::uint64_t count, const RowsDigest& rows, SealedContent& content) const {
  if (schema < kFirstChunked) return require_content(count, rows.value());
  add_rest(content);
  if (stored_chunks() != content.chunks()) damaged("its chunks are not those that were published");
  require_content(count, content.digest());
}

// A live file has a log beside it, and an older schema may have other columns.
std::unique_ptr<RowSource> ArchiveReader::Impl::rows_of(const char* table, const std::string& values,
                                                        const char* key) const {
  if (published && schema >= kFirstJudged) {
    if (auto pages = TablePages::open(*db, path, table, values)) return pages;
  }
  return std::make_unique<Query>(*db, fmt::format("SELECT {} FROM {} ORDER BY {}", values, table, key));
}

// The rows of runs with their parts. The tables are stored in the order of their keys, so one pass over each is enough.
class ArchiveReader::Impl::Rows {
 public:
  explicit Rows(const Impl& file) : file_(file), runs_(file.rows_of("runs", run_values(file.schema), "run_index")) {
    for (const auto& table : part_tables()) {
      auto rows = file.rows_of(table.name, table.values(file.schema), "run_index, ordinal");
      const bool more = rows->step();
      parts_.push_back({table, std::move(rows), more});
    }
  }

  // Null after the last. The checksum was right. Valid until the next call, which writes over it.
  StoredRun* next() {
    if (!runs_->step()) {
      require_end();
      return nullptr;
    }
    file_.take_run(*runs_, stored_);
    for (auto& part : parts_) {
      std::size_t count = 0;
      for (; part.more && run_of(*part.rows) == stored_.run.run_index; part.more = part.rows->step())
        file_.take_part(part.table, *part.rows, stored_, count++);
      part.table.cut(stored_.run.outcome, count);
    }
    file_.verify(stored_);
    digest_.add(stored_.checksum);
    return &stored_;
  }
  const RowsDigest& digest() const { return digest_; }

 private:
  struct Part {
    const PartTable& table;
    std::unique_ptr<RowSource> rows;
    bool more;
  };
  void require_end() const {
    for (const auto& part : parts_) {
      if (part.more)
        file_.damaged(fmt::format("it holds {} of run {}, but not the run", part.table.name, run_of(*part.rows)));
    }
  }

  const Impl& file_;
  std::unique_ptr<RowSource> runs_;
  std::vector<Part> parts_;
  StoredRun stored_;
  RowsDigest digest_;
};

// Returns the digest of the rows, also of those that are folded.
std::uint64_t ArchiveReader::Impl::read_all(const VisitRun& visit, const VisitFolded& visit_folded) const {
  const Snapshot snapshot(*db);
  if (!fold) return read_rows(visit);
  try {
    return read_folded_file(visit, visit_folded);
  } catch (const BrokenFold& e) {
    damaged(e.what());
  }
}

std::uint64_t ArchiveReader::Impl::read_rows(const VisitRun& visit) const {
  Rows rows(*this);
  SealedContent content(plan.campaign.chunk_runs);
  SeenTraces seen;
  std::uint64_t count = 0;
  for (; StoredRun* stored = rows.next(); ++count) {
    content.add_run(count, stored->checksum);
    stored->run.repeats = !seen.add(stored->run);
    visit(stored->run);
  }
  if (sealed_count) require_sealed(count, rows.digest(), content);
  return rows.digest().value();
}

std::uint64_t ArchiveReader::Impl::read_folded_file(const VisitRun& visit, const VisitFolded& visit_folded) const {
  if (!sealed_count) damaged("it is folded, but has no seal");
  Rows rows(*this);
  FoldedRows folded(*db, schema, plan.cells, visit_folded.met);
  StoredRun* kept = rows.next();
  std::uint64_t index = 0;
  while (index < *sealed_count) {
    if (visit_folded.quiet && index % plan.cells.size() == 0) {
      const QuietReplicates quiet = folded.skip_quiet(index);
      if (quiet.replicates > 0) {
        visit_folded.quiet(quiet);
        index += quiet.replicates * plan.cells.size();
        continue;
      }
    }
    if (const FoldedPlace place = folded.next(index); place.known) {
      visit(*place.known);
    } else {
      if (kept == nullptr || kept->run.run_index != index)
        damaged(fmt::format("run {} is neither folded nor kept", index));
      kept->run.repeats = place.repeats;
      visit(kept->run);
      kept = rows.next();
    }
    ++index;
  }
  if (kept != nullptr) damaged(fmt::format("run {} is beside the folded runs", kept->run.run_index));
  SealedContent content(plan.campaign.chunk_runs);
  for (const ChunkRecord& chunk : stored_chunks()) content.add_chunk(chunk);
  add_rest(content);
  const FoldedContent found{content.digest(), fold->rows, fold->repeated_traces, rows.digest().value(),
                            folded.digest()};
  require_content(index, digest_of(found));
  return fold->rows;
}

ArchiveReader::ArchiveReader(const std::string& path, Checksums checksums) : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->checksums = checksums;
  impl_->open();
}

ArchiveReader::~ArchiveReader() = default;

std::int32_t ArchiveReader::schema() const { return impl_->schema; }
const StoredPlan& ArchiveReader::plan() const { return impl_->plan; }

std::uint64_t ArchiveReader::run_count() const {
  if (impl_->sealed_count) return *impl_->sealed_count;
  return impl_->guarded(
      [&] { return static_cast<std::uint64_t>(impl_->db->execAndGet("SELECT count(*) FROM runs").getInt64()); });
}

bool ArchiveReader::is_published() const { return impl_->published; }

bool ArchiveReader::is_folded() const { return impl_->fold.has_value(); }

std::uint64_t ArchiveReader::unplaced_repeats() const {
  return impl_->fold && impl_->schema < kFirstJudged ? impl_->fold->repeated_traces : 0;
}

std::optional<KnownRun> ArchiveReader::folded_run(std::uint64_t run_index) const {
  if (!is_folded()) return std::nullopt;
  return impl_->guarded([&] {
    try {
      return find_folded(*impl_->db, impl_->schema, impl_->plan.cells, run_index);
    } catch (const BrokenFold& e) {
      impl_->damaged(e.what());
    }
  });
}

std::optional<RunRecord> ArchiveReader::run(std::uint64_t run_index) const {
  return impl_->guarded([&]() -> std::optional<RunRecord> {
    const Snapshot snapshot(*impl_->db);
    Query rows(*impl_->db, fmt::format("SELECT {} FROM runs WHERE run_index = ?", run_values(impl_->schema)));
    rows.bind(1, std::bit_cast<std::int64_t>(run_index));
    if (!rows.step()) return std::nullopt;
    StoredRun stored;
    impl_->take_run(rows, stored);
    for (const auto& table : part_tables()) {
      Query parts(*impl_->db, fmt::format("SELECT {} FROM {} WHERE run_index = ? ORDER BY ordinal",
                                          table.values(impl_->schema), table.name));
      parts.bind(1, std::bit_cast<std::int64_t>(run_index));
      for (std::size_t ordinal = 0; parts.step(); ++ordinal) impl_->take_part(table, parts, stored, ordinal);
    }
    impl_->verify(stored);
    return std::move(stored.run);
  });
}

void ArchiveReader::for_each_audit(const std::function<void(const AuditRecord&, bool same)>& visit) const {
  if (impl_->schema < kFirstChunked) return;
  impl_->guarded([&] {
    const Snapshot snapshot(*impl_->db);
    Query rows(*impl_->db,
               fmt::format("SELECT {}, coalesce(checksum = (SELECT r.checksum FROM runs r WHERE r.run_index = "
                           "audits.run_index), {}) AS same FROM audits ORDER BY run_index",
                           audit_values(impl_->schema), is_folded() ? "1" : "NULL"));
    const int same = rows.column_of("same");
    while (rows.step()) {
      if (!rows.is_null(same)) visit(read_audit(rows), rows.number(same) != 0);
    }
  });
}

std::optional<std::string> ArchiveReader::recording(std::uint64_t run_index) const {
  if (impl_->schema < kFirstChunked) return std::nullopt;
  return impl_->guarded([&]() -> std::optional<std::string> {
    Query rows(*impl_->db, "SELECT calls, checksum FROM recordings WHERE run_index = ?");
    rows.bind(1, std::bit_cast<std::int64_t>(run_index));
    if (!rows.step()) return std::nullopt;
    std::string calls(rows.bytes(0));
    if (recording_checksum(calls) != std::bit_cast<std::uint64_t>(rows.number(1)))
      impl_->damaged(fmt::format("the recording of run {} does not match its checksum", run_index));
    return calls;
  });
}

std::uint64_t ArchiveReader::recording_count(const std::string& agent) const {
  if (impl_->schema < kFirstChunked) return 0;
  return impl_->guarded([&] {
    Query rows(*impl_->db,
               "SELECT count(*) FROM recordings x JOIN runs r ON r.run_index = x.run_index JOIN cells c ON "
               "c.cell = r.cell WHERE c.agent = ?");
    rows.bind(1, agent);
    rows.step();
    return static_cast<std::uint64_t>(rows.number(0));
  });
}

std::vector<std::uint64_t> ArchiveReader::recorded_clean_runs() const {
  if (impl_->schema < kFirstChunked) return {};
  return impl_->guarded([&] {
    std::vector<std::uint64_t> found;
    Query rows(*impl_->db,
               fmt::format("SELECT x.run_index FROM recordings x JOIN runs r ON r.run_index = x.run_index WHERE "
                           "r.outcome_class = '{}' ORDER BY x.run_index",
                           name_of(OutcomeClass::Clean)));
    while (rows.step()) found.push_back(run_of(rows));
    return found;
  });
}

std::optional<std::uint64_t> ArchiveReader::seal() const { return impl_->published ? impl_->seal : std::nullopt; }

void ArchiveReader::for_each_run(const VisitRun& visit, const VisitFolded& visit_folded) const {
  impl_->guarded([&] { impl_->read_all(visit, visit_folded); });
}

std::uint64_t ArchiveReader::content_digest() const {
  return impl_->guarded(
      [&] { return content_digest_of(impl_->stored_checksum, impl_->read_all([](const RunRecord&) {})); });
}

std::uint64_t ArchiveReader::results_digest() const {
  StoredPlan without_engine = impl_->plan;
  without_engine.campaign.engine = {};
  const std::uint64_t plan = plan_checksum(without_engine);
  return impl_->guarded([&] { return content_digest_of(plan, impl_->read_all([](const RunRecord&) {})); });
}

}  // namespace fleetproof
