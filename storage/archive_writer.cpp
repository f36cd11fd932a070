#include "storage/archive_writer.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/canonical_file.hpp"
#include "storage/checksum.hpp"
#include "storage/durable_file.hpp"
#include "storage/live_file.hpp"
#include "storage/plan_rows.hpp"
#include "storage/row_store.hpp"
#include "storage/rows.hpp"
#include "storage/schema.hpp"
#include "storage/sqlite_errors.hpp"
#include "storage/statement.hpp"
#include "storage/target_file.hpp"
#include "storage/write_lock.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kRowsPerCommit = 4096;
constexpr std::chrono::seconds kCommitPeriod{2};
constexpr const char* kPartial = ".partial";
constexpr std::size_t kBytesOfARow = 4096;  // a recording counts as so many rows

bool counts_hours(const GateRecord& gate) {
  return gate.unit == GateUnit::AgvHour && gate.method == GateMethod::AnyTime;
}

}  // namespace

struct ArchiveWriter::Impl {
  std::optional<WriteLock> lock;  // the first member: it is released last
  std::string path, live_path;
  LiveName live_name = LiveName::Partial;
  Existing existing = Existing::Refuse;
  std::uint64_t cells = 0;
  std::unique_ptr<SQLite::Database> db;
  std::unique_ptr<RowStore> rows;
  std::size_t pending = 0;  // rows since the last commit
  std::chrono::steady_clock::time_point last_commit = std::chrono::steady_clock::now();

  std::string unfinished() const { return path + ".unfinished"; }
  void create(const StoredPlan& plan, std::unique_ptr<ArchiveReader> earlier = nullptr);
  void go_on(StoredPlan plan, const Resumption& resumption);
  void open(const std::string& file);
  void insert_plan(const StoredPlan& plan);
  void begin();
  void store(const RunRecord& run);
  void take_over(const ArchiveReader& earlier);
  void commit();
  void close();
  void drop();
  template <class Action>
  void or_drop(Action action);
};

void ArchiveWriter::Impl::open(const std::string& file) {
  // One thread writes: SQLite need not lock its own memory at each of the 60 values of a row.
  db = std::make_unique<SQLite::Database>(file, SQLite::OPEN_READWRITE | SQLite::OPEN_NOMUTEX);
  // FULL brings the log to the disk at every commit: a power cut then costs no more than a kill.
  db->exec("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL");
  db->exec("PRAGMA cache_size=-8000");  // the rows of one commit stay in memory until then
}

void ArchiveWriter::Impl::insert_plan(const StoredPlan& plan) {
  auto insert_campaign = insert_into(*db, "campaign", kCampaignColumns);
  bind_campaign(insert_campaign, plan.campaign, plan_checksum(plan));
  insert_campaign.run();
  auto insert_cell = insert_into(*db, "cells", cell_columns());
  for (const auto& cell : plan.cells) {
    bind_cell(insert_cell, cell);
    insert_cell.run();
  }
  auto insert_gate = insert_into(*db, "gates", gate_columns());
  for (const auto& gate : plan.gates) {
    bind_gate(insert_gate, gate);
    insert_gate.run();
  }
}

void ArchiveWriter::Impl::create(const StoredPlan& plan, std::unique_ptr<ArchiveReader> earlier) {
  const std::string begun = new_live_name(path);
  const bool in_place_of_earlier = earlier != nullptr;
  remove_live_file(begun);
  make_live_file(begun);
  try {
    db = std::make_unique<SQLite::Database>(begun, SQLite::OPEN_READWRITE);
    db->exec(fmt::format("PRAGMA page_size={}; PRAGMA application_id={}; PRAGMA user_version={}", kLivePageSize,
                         kApplicationId, kSchemaVersion));
    // Without a log until it is whole: closing a file that has one can fail silently.
    db->exec("BEGIN");
    db->exec(live_schema_ddl());
    insert_plan(plan);
    db->exec("COMMIT");
    if (earlier) {
      rows = std::make_unique<RowStore>(*db);
      take_over(*earlier);
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
    rows = std::make_unique<RowStore>(*db);
  } catch (...) {
    drop();
    remove_live_file(begun);
    if (!in_place_of_earlier) remove_live_file(live_path);  // it holds no run, and would prevent the next try
    throw_archive_error(live_path);
  }
}

void ArchiveWriter::Impl::go_on(StoredPlan plan, const Resumption& resumption) {
  auto stored = std::make_unique<ArchiveReader>(live_path);
  if (stored->is_folded())
    throw InputError(path,
                     "its runs without a failure are folded (keep = \"failing\"), so this campaign cannot go on; "
                     "give another name with --db, or --overwrite to begin again");
  const bool counts_otherwise = stored->schema() < kFirstJudged && std::ranges::any_of(stored->gates(), counts_hours);
  if (counts_otherwise)
    throw InputError(
        path,
        "a gate of it counts AGV-hours as earlier versions did, in microseconds, so this campaign cannot go on; give "
        "another name with --db, or --overwrite to begin again");
  resumption.check(stored->campaign(), plan.campaign);
  resumption.visit_recorded_clean(stored->recorded_clean_runs());
  stored->for_each_audit(resumption.visit_audit);
  stored->for_each_run(resumption.visit);
  if (stored->schema() < kSchemaVersion) {
    create(plan, std::move(stored));
    return;
  }
  stored.reset();
  try {
    open(live_path);
    db->exec("BEGIN");
    // The plan may have grown by replicates, and a live file is not sealed.
    db->exec("DELETE FROM campaign; DELETE FROM cells; DELETE FROM gates");
    insert_plan(plan);
    db->exec("COMMIT");
    rows = std::make_unique<RowStore>(*db);
  } catch (const SQLite::Exception&) {
    drop();
    throw_archive_error(live_path);
  }
}

void ArchiveWriter::Impl::begin() {
  if (pending == 0) db->exec("BEGIN");
  ++pending;
}

void ArchiveWriter::Impl::store(const RunRecord& run) {
  begin();
  pending += run.recording.size() / kBytesOfARow;
  // After an interruption, a run may be simulated twice. Both results must be equal.
  if (!rows->add(run))
    throw EngineError(fmt::format("{}: run {} is stored already, with another outcome: the same run ended in two ways",
                                  live_path, run.run_index));
}

// From a file of an older schema. An audit that came out as its run did has the checksum of the new row; another one
// keeps its own, which no row has.
void ArchiveWriter::Impl::take_over(const ArchiveReader& earlier) {
  earlier.for_each_run([&](const RunRecord& run) {
    auto calls = earlier.recording(run.run_index);
    if (!calls) return store(run);
    RunRecord recorded = run;
    recorded.recording = *std::move(calls);
    store(recorded);
  });
  earlier.for_each_audit([&](const AuditRecord& audit, bool same) {
    begin();
    AuditRecord kept = audit;
    if (same) kept.checksum = row_checksum(*earlier.run(audit.run_index));
    rows->add(kept);
  });
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
  rows.reset();
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

ArchiveWriter::ArchiveWriter(const std::string& path, const StoredPlan& plan, Existing existing,
                             const Resumption& resumption, LiveName live_name)
    : impl_(std::make_unique<Impl>()) {
  require_place(path);
  impl_->path = absolute_name(path);
  impl_->live_path = impl_->path + (live_name == LiveName::Merging ? ".merging" : kPartial);
  impl_->live_name = live_name;
  impl_->existing = existing;
  impl_->cells = plan.cells.size();
  impl_->lock.emplace(impl_->path);
  require_free_name(impl_->path, existing);
  require_free_live_name(impl_->path + kPartial, existing);
  if (live_name == LiveName::Merging) require_own_rest(impl_->live_path);
  require_own_rest(new_live_name(impl_->path));
  require_own_rest(impl_->unfinished());
  const LiveFile live =
      existing == Existing::Resume ? bring_back_live_file(impl_->path, impl_->live_path) : LiveFile::None;
  if (live != LiveFile::None) {
    try {
      impl_->go_on(plan, resumption);
    } catch (...) {
      impl_->db.reset();
      if (live == LiveFile::Copied) remove_live_file(impl_->live_path);
      throw;
    }
    return;
  }
  if (existing == Existing::Resume) impl_->existing = Existing::Refuse;  // there is nothing to go on with
  if (existing == Existing::Replace || live_name == LiveName::Merging) remove_live_file(impl_->live_path);
  impl_->create(plan);
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

void ArchiveWriter::add(const AuditRecord& audit) {
  ensure(impl_->db != nullptr, "an audit is added before the archive is published, and not after an error");
  impl_->or_drop([&] {
    impl_->begin();
    impl_->rows->add(audit);
  });
}

void ArchiveWriter::commit() {
  ensure(impl_->db != nullptr, "an archive is committed before it is published, and not after an error");
  impl_->or_drop([&] { impl_->commit(); });
}

void ArchiveWriter::publish(std::uint64_t stop_index, const MayFold& may_fold) {
  ensure(impl_->db != nullptr, "an archive is published once, and not after an error");
  const std::string unfinished = impl_->unfinished();
  impl_->or_drop([&] { impl_->close(); });
  require_own_rest(unfinished);
  write_canonical_file(impl_->live_path, unfinished, stop_index, may_fold);
  try {
    // `sqlite3 NAME` leaves an empty file: somebody looked for results too early.
    if (!is_empty_file(impl_->path)) require_free_name(impl_->path, impl_->existing);
  } catch (const InputError&) {
    if (impl_->live_name == LiveName::Merging)
      throw InputError(impl_->path, "this file appeared while the chunks were put together; give another name");
    throw InputError(impl_->path, fmt::format("this file appeared while the campaign ran; the results are in {} and {}",
                                              unfinished, impl_->live_path));
  }
  move_durably(unfinished, impl_->path);
  remove_live_file(impl_->live_path);
  remove_live_file(impl_->path + kPartial);
  remove_live_file(new_live_name(impl_->path));  // of a program that was killed at its start
  impl_->lock.reset();
}

void ArchiveWriter::discard() {
  impl_->drop();
  remove_live_file(impl_->live_path);
  std::error_code ignored;
  std::filesystem::remove(impl_->unfinished(), ignored);
  impl_->lock.reset();
}

}  // namespace fleetproof
