#include "storage/canonical_file.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <limits>

#include "storage/checksum.hpp"
#include "storage/opened_file.hpp"
#include "storage/rows.hpp"
#include "storage/schema.hpp"
#include "storage/sealed_content.hpp"
#include "storage/sqlite_errors.hpp"

namespace fleetproof {
namespace {

// Sets every property that SQLite could choose by itself. Otherwise the bytes would depend on how a distribution built
// SQLite.
void fix_format(SQLite::Database& db) {
  db.exec(fmt::format("PRAGMA page_size={}; PRAGMA encoding='UTF-8'; PRAGMA auto_vacuum=NONE; PRAGMA secure_delete=ON",
                      kPageSize));
  db.exec("PRAGMA journal_mode=DELETE; PRAGMA synchronous=FULL");
}

void copy_rows(SQLite::Database& db, std::uint64_t stop_index) {
  db.exec(fmt::format("INSERT INTO campaign ({0}) SELECT {0} FROM live.campaign ORDER BY id", kCampaignColumns));
  db.exec(fmt::format("INSERT INTO cells ({0}) SELECT {0} FROM live.cells ORDER BY cell", cell_columns()));
  db.exec(fmt::format("INSERT INTO gates ({0}) SELECT {0} FROM live.gates ORDER BY gate", gate_columns()));
  const auto copy_below_stop = [&](const std::string& table, const std::string& columns, const std::string& key) {
    SQLite::Statement copy(
        db, fmt::format("INSERT INTO {0} ({1}) SELECT {1} FROM live.{0} WHERE run_index < ? ORDER BY {2}", table,
                        columns, key));
    copy.bind(1,
              static_cast<std::int64_t>(std::min<std::uint64_t>(stop_index, std::numeric_limits<std::int64_t>::max())));
    copy.exec();
  };
  copy_below_stop("runs", run_columns(), "run_index");
  copy_below_stop("violations", violation_columns(), "run_index, ordinal");
  copy_below_stop("incidents", kIncidentColumns, "run_index, ordinal");
  copy_below_stop("probes", kProbeColumns, "run_index, ordinal");
  copy_below_stop("audits", kAuditColumns, "run_index");
  // Runs of software that has passed its audits are replayed from their seeds. A row that is never written
  // leaves no trace in the file, one that is deleted would.
  db.exec(
      fmt::format("INSERT INTO recordings ({}) SELECT x.run_index, x.calls, x.checksum FROM live.recordings x JOIN "
                  "main.runs r ON r.run_index = x.run_index JOIN main.cells c ON c.cell = r.cell WHERE c.agent NOT "
                  "IN (SELECT agent FROM main.v1_audits GROUP BY agent HAVING min(same) = 1 AND count(*) >= {}) "
                  "ORDER BY x.run_index",
                  kRecordingColumns, kAuditsToPass));
}

// With the count and the seal, a lost or added row and a changed view are noticed too, not only a changed row.
void seal(SQLite::Database& db) {
  const auto number = [&](const char* query) { return std::bit_cast<std::uint64_t>(db.execAndGet(query).getInt64()); };
  SealedContent content(number("SELECT chunk_runs FROM main.campaign"));
  std::int64_t count = 0;
  SQLite::Statement rows(db, "SELECT checksum FROM main.runs ORDER BY run_index");
  for (; rows.executeStep(); ++count)
    content.add_run(static_cast<std::uint64_t>(count), std::bit_cast<std::uint64_t>(rows.getColumn(0).getInt64()));
  content.add_rest(db);
  SQLite::Statement insert(db, fmt::format("INSERT INTO main.chunks ({}) VALUES (?, ?, ?)", kChunkColumns));
  for (const ChunkRecord& chunk : content.chunks()) {
    insert.reset();
    bind_chunk(insert, chunk);
    insert.exec();
  }
  const auto seal = seal_of(schema_text(db), number("SELECT plan_checksum FROM main.campaign"),
                            static_cast<std::uint64_t>(count), content.digest());
  SQLite::Statement update(db, "UPDATE main.campaign SET run_count = ?, seal = ?");
  update.bind(1, count);
  update.bind(2, std::bit_cast<std::int64_t>(seal));
  update.exec();
}

void remove_with_journal(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  std::filesystem::remove(path + "-journal", ignored);
}

}  // namespace

void write_canonical_file(const std::string& live_path, const std::string& target, std::uint64_t stop_index) {
  remove_with_journal(target);
  try {
    SQLite::Database db(target, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    fix_format(db);
    SQLite::Statement attach(db, "ATTACH ? AS live");
    attach.bind(1, live_path);
    attach.exec();
    SQLite::Transaction transaction(db);
    db.exec(fmt::format("PRAGMA main.application_id={}; PRAGMA main.user_version={}", kApplicationId, kSchemaVersion));
    db.exec(schema_ddl());
    copy_rows(db, stop_index);
    seal(db);
    transaction.commit();
  } catch (const SQLite::Exception&) {
    remove_with_journal(target);
    throw_archive_error(target);
  }
}

}  // namespace fleetproof
