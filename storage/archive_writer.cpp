#include "storage/archive_writer.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/canonical_file.hpp"
#include "storage/checksum.hpp"
#include "storage/live_file.hpp"
#include "storage/rows.hpp"
#include "storage/schema.hpp"
#include "storage/sqlite_errors.hpp"
#include "storage/target_file.hpp"
#include "storage/write_lock.hpp"

namespace fleetproof {
namespace {

constexpr unsigned kRowsPerCommit = 4096;
constexpr std::chrono::seconds kCommitPeriod{2};

// Inserts the violations, incidents or probes of a run, several with one statement: running a statement costs as much
// as binding a dozen values.
template <class Part>
class PartsInsert {
 public:
  using Bind = void (*)(SQLite::Statement&, int first, std::uint64_t run_index, std::size_t ordinal, const Part&);

  PartsInsert(SQLite::Database& db, std::string table, std::string columns, Bind bind)
      : db_(db), table_(std::move(table)), columns_(std::move(columns)), bind_(bind) {}

  void insert(std::uint64_t run_index, const std::vector<Part>& parts) {
    for (std::size_t done = 0; done < parts.size();) {
      const std::size_t rows = std::min(parts.size() - done, statements_.size());
      SQLite::Statement& statement = statement_of(rows);
      statement.reset();
      for (std::size_t row = 0; row < rows; ++row, ++done)
        bind_(statement, 1 + static_cast<int>(row) * count_, run_index, done, parts[done]);
      statement.exec();
    }
  }

 private:
  SQLite::Statement& statement_of(std::size_t rows) {
    auto& statement = statements_[rows - 1];
    if (!statement) {
      std::string values = fmt::format("({})", placeholders(columns_));
      const std::string row = ", " + values;
      for (std::size_t i = 1; i < rows; ++i) values += row;
      statement.emplace(db_, fmt::format("INSERT INTO {} ({}) VALUES {}", table_, columns_, values));
    }
    return *statement;
  }

  SQLite::Database& db_;
  const std::string table_, columns_;
  const Bind bind_;
  const int count_ = 1 + static_cast<int>(std::ranges::count(columns_, ','));
  std::array<std::optional<SQLite::Statement>, 8> statements_;  // by their number of rows
};

}  // namespace

struct ArchiveWriter::Impl {
  std::optional<WriteLock> lock;  // the first member: it is released last
  std::string path, live_path;
  Existing existing = Existing::Refuse;
  std::uint64_t cells = 0;
  std::unique_ptr<SQLite::Database> db;
  std::unique_ptr<SQLite::Statement> insert_run, stored_checksum;
  std::unique_ptr<PartsInsert<Violation>> violations;
  std::unique_ptr<PartsInsert<Incident>> incidents;
  std::unique_ptr<PartsInsert<ProbeCount>> probes;
  unsigned pending = 0;
  std::chrono::steady_clock::time_point last_commit = std::chrono::steady_clock::now();

  void create(const CampaignRecord& campaign, const std::vector<CellRecord>& cell_records,
              const std::vector<GateRecord>& gates, std::unique_ptr<ArchiveReader> earlier = nullptr);
  void go_on(CampaignRecord campaign, const std::vector<CellRecord>& cell_records, const std::vector<GateRecord>& gates,
             const Resumption& resumption);
  void open(const std::string& file);
  void insert_plan(const CampaignRecord& campaign, const std::vector<CellRecord>& cell_records,
                   const std::vector<GateRecord>& gates);
  void prepare();
  SQLite::Statement insert_into(const std::string& table, const std::string& columns);
  void store(const RunRecord& run);
  void commit();
  void close();
  void drop();
  template <class Action>
  void or_drop(Action action);
};

void ArchiveWriter::Impl::open(const std::string& file) {
  // One thread writes: SQLite need not lock its own memory at each of the fifty values of a row.
  db = std::make_unique<SQLite::Database>(file, SQLite::OPEN_READWRITE | SQLite::OPEN_NOMUTEX);
  // FULL brings the log to the disk at every commit: a power cut then costs no more than a kill.
  db->exec("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL");
  db->exec("PRAGMA cache_size=-8000");  // the rows of one commit stay in memory until then
}

SQLite::Statement ArchiveWriter::Impl::insert_into(const std::string& table, const std::string& columns) {
  return {*db, fmt::format("INSERT INTO {} ({}) VALUES ({})", table, columns, placeholders(columns))};
}

void ArchiveWriter::Impl::insert_plan(const CampaignRecord& campaign, const std::vector<CellRecord>& cell_records,
                                      const std::vector<GateRecord>& gates) {
  auto insert_campaign = insert_into("campaign", kCampaignColumns);
  bind_campaign(insert_campaign, campaign, plan_checksum(campaign, cell_records, gates));
  insert_campaign.exec();
  auto insert_cell = insert_into("cells", cell_columns());
  for (const auto& cell : cell_records) {
    insert_cell.reset();
    bind_cell(insert_cell, cell);
    insert_cell.exec();
  }
  auto insert_gate = insert_into("gates", kGateColumns);
  for (const auto& gate : gates) {
    insert_gate.reset();
    bind_gate(insert_gate, gate);
    insert_gate.exec();
  }
}

void ArchiveWriter::Impl::create(const CampaignRecord& campaign, const std::vector<CellRecord>& cell_records,
                                 const std::vector<GateRecord>& gates, std::unique_ptr<ArchiveReader> earlier) {
  const std::string begun = new_live_name(path);
  const bool in_place_of_earlier = earlier != nullptr;
  remove_live_file(begun);
  make_live_file(begun);
  try {
    db = std::make_unique<SQLite::Database>(begun, SQLite::OPEN_READWRITE);
    db->exec(fmt::format("PRAGMA page_size={}; PRAGMA application_id={}; PRAGMA user_version={}", kPageSize,
                         kApplicationId, kSchemaVersion));
    // Without a log until it is whole: closing a file that has one can fail silently.
    db->exec("BEGIN");
    db->exec(live_schema_ddl());
    insert_plan(campaign, cell_records, gates);
    db->exec("COMMIT");
    if (earlier) {
      prepare();
      earlier->for_each_run([this](const RunRecord& run) { store(run); });
      close();
      earlier.reset();
      fold_log(live_path);
      db = std::make_unique<SQLite::Database>(begun, SQLite::OPEN_READWRITE);
    }
    db->exec("PRAGMA journal_mode=WAL");
    db.reset();
    remove_log(live_path);  // it would be read as the log of the file that takes the name
    move_durably(begun, live_path);
    open(live_path);
    prepare();
  } catch (...) {
    drop();
    remove_live_file(begun);
    if (!in_place_of_earlier) remove_live_file(live_path);  // it holds no run, and would prevent the next try
    throw_archive_error(live_path);
  }
}

void ArchiveWriter::Impl::go_on(CampaignRecord campaign, const std::vector<CellRecord>& cell_records,
                                const std::vector<GateRecord>& gates, const Resumption& resumption) {
  auto stored = std::make_unique<ArchiveReader>(live_path);
  resumption.check(stored->campaign(), campaign);
  stored->for_each_run(resumption.visit);
  if (stored->schema() < kSchemaVersion) {
    create(campaign, cell_records, gates, std::move(stored));
    return;
  }
  stored.reset();
  try {
    open(live_path);
    db->exec("BEGIN");
    // The plan may have grown by replicates, and a live file is not sealed.
    db->exec("DELETE FROM campaign; DELETE FROM cells; DELETE FROM gates");
    insert_plan(campaign, cell_records, gates);
    db->exec("COMMIT");
    prepare();
  } catch (const SQLite::Exception&) {
    drop();
    throw_archive_error(live_path);
  }
}

void ArchiveWriter::Impl::prepare() {
  const auto runs = run_columns();
  insert_run = std::make_unique<SQLite::Statement>(
      *db,
      fmt::format("INSERT INTO runs ({}) VALUES ({}) ON CONFLICT (run_index) DO NOTHING", runs, placeholders(runs)));
  violations = std::make_unique<PartsInsert<Violation>>(*db, "violations", violation_columns(), bind_violation);
  incidents = std::make_unique<PartsInsert<Incident>>(*db, "incidents", kIncidentColumns, bind_incident);
  probes = std::make_unique<PartsInsert<ProbeCount>>(*db, "probes", kProbeColumns, bind_probe);
  stored_checksum = std::make_unique<SQLite::Statement>(*db, "SELECT checksum FROM runs WHERE run_index = ?");
}

void ArchiveWriter::Impl::store(const RunRecord& run) {
  if (pending == 0) db->exec("BEGIN");
  ++pending;
  const auto checksum = row_checksum(run);
  insert_run->reset();
  bind_run(*insert_run, run, checksum);
  if (insert_run->exec() == 1) {
    violations->insert(run.run_index, run.outcome.violations);
    incidents->insert(run.run_index, run.outcome.incidents);
    probes->insert(run.run_index, run.outcome.probes);
    return;
  }
  // After an interruption, a run may be simulated twice. Both results must be equal.
  stored_checksum->reset();
  stored_checksum->bind(1, static_cast<std::int64_t>(run.run_index));
  const bool same = stored_checksum->executeStep() &&
                    std::bit_cast<std::uint64_t>(stored_checksum->getColumn(0).getInt64()) == checksum;
  stored_checksum->reset();
  if (!same)
    throw EngineError(fmt::format("{}: run {} is stored already, with another outcome: the same run ended in two ways",
                                  live_path, run.run_index));
}

void ArchiveWriter::Impl::commit() {
  last_commit = std::chrono::steady_clock::now();
  if (pending == 0) return;
  pending = 0;
  db->exec("COMMIT");
}

void ArchiveWriter::Impl::close() {
  commit();
  drop();
}

// Closes the file. What was not committed is rolled back.
void ArchiveWriter::Impl::drop() {
  pending = 0;
  insert_run.reset();
  violations.reset();
  incidents.reset();
  probes.reset();
  stored_checksum.reset();
  db.reset();
}

// After an error, half a run may be stored. Nothing of it may be committed later.
template <class Action>
void ArchiveWriter::Impl::or_drop(Action action) {
  try {
    action();
  } catch (const SQLite::Exception&) {
    drop();
    throw_archive_error(live_path);
  }
}

ArchiveWriter::ArchiveWriter(const std::string& path, const CampaignRecord& campaign,
                             const std::vector<CellRecord>& cells, const std::vector<GateRecord>& gates,
                             Existing existing, const Resumption& resumption)
    : impl_(std::make_unique<Impl>()) {
  require_place(path);
  impl_->path = absolute_name(path);
  impl_->live_path = impl_->path + ".partial";
  impl_->existing = existing;
  impl_->cells = cells.size();
  impl_->lock.emplace(impl_->path);
  require_free_name(impl_->path, existing);
  require_free_live_name(impl_->live_path, existing);
  const LiveFile live =
      existing == Existing::Resume ? bring_back_live_file(impl_->path, impl_->live_path) : LiveFile::None;
  if (live != LiveFile::None) {
    try {
      impl_->go_on(campaign, cells, gates, resumption);
    } catch (...) {
      impl_->db.reset();
      if (live == LiveFile::Copied) remove_live_file(impl_->live_path);
      throw;
    }
    return;
  }
  if (existing == Existing::Resume) impl_->existing = Existing::Refuse;  // there is nothing to go on with
  if (existing == Existing::Replace) remove_live_file(impl_->live_path);
  impl_->create(campaign, cells, gates);
}

ArchiveWriter::~ArchiveWriter() {
  if (!impl_->db) return;
  try {
    impl_->close();
  } catch (const SQLite::Exception&) {  // committed rows stay; a destructor cannot report an error
  }
}

void ArchiveWriter::add(const RunRecord& run) {
  ensure(impl_->db != nullptr, "a run is added before the archive is published, and not after an error");
  ensure(run.cell < impl_->cells, "a stored run belongs to a cell of its campaign");
  ensure(run.run_index == run.replicate * impl_->cells + run.cell, "run_index = replicate x cells + cell");
  ensure(run.run_index <= std::numeric_limits<std::int64_t>::max(), "a run index fits the archive");
  impl_->or_drop([&] {
    impl_->store(run);
    if (impl_->pending >= kRowsPerCommit || std::chrono::steady_clock::now() - impl_->last_commit >= kCommitPeriod)
      impl_->commit();
  });
}

void ArchiveWriter::commit() {
  ensure(impl_->db != nullptr, "an archive is committed before it is published, and not after an error");
  impl_->or_drop([&] { impl_->commit(); });
}

void ArchiveWriter::publish(std::uint64_t stop_index) {
  ensure(impl_->db != nullptr, "an archive is published once, and not after an error");
  const auto unfinished = impl_->path + ".unfinished";
  impl_->or_drop([&] { impl_->close(); });
  write_canonical_file(impl_->live_path, unfinished, stop_index);
  try {
    require_free_name(impl_->path, impl_->existing);
  } catch (const InputError&) {
    throw InputError(impl_->path, fmt::format("this file appeared while the campaign ran; the results are in {} and {}",
                                              unfinished, impl_->live_path));
  }
  move_durably(unfinished, impl_->path);
  remove_live_file(impl_->live_path);
  remove_live_file(new_live_name(impl_->path));  // of a program that was killed at its start
  impl_->lock.reset();
}

}  // namespace fleetproof
