#include "storage/canonical_file.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <limits>
#include <optional>

#include "storage/checksum.hpp"
#include "storage/opened_file.hpp"
#include "storage/rows.hpp"
#include "storage/schema.hpp"
#include "storage/sealed_content.hpp"
#include "storage/sqlite_errors.hpp"
#include "storage/statement.hpp"

namespace fleetproof {
namespace {

// Sets every property that SQLite could choose by itself. Otherwise the bytes would depend on how a distribution built
// SQLite.
void fix_format(SQLite::Database& db) {
  db.exec(fmt::format("PRAGMA page_size={}; PRAGMA encoding='UTF-8'; PRAGMA auto_vacuum=NONE; PRAGMA secure_delete=ON",
                      kPageSize));
  db.exec("PRAGMA journal_mode=DELETE; PRAGMA synchronous=FULL");
}

void copy_plan(SQLite::Database& db) {
  db.exec(fmt::format("INSERT INTO campaign ({0}) SELECT {0} FROM live.campaign ORDER BY id", kCampaignColumns));
  db.exec(fmt::format("INSERT INTO cells ({0}) SELECT {0} FROM live.cells ORDER BY cell", cell_columns()));
  db.exec(fmt::format("INSERT INTO gates ({0}) SELECT {0} FROM live.gates ORDER BY gate", gate_columns()));
}

// As SQL: rows below the stop; of folded runs, only those that are kept.
class CopiedRows {
 public:
  CopiedRows(SQLite::Database& db, std::uint64_t stop_index, bool folded)
      : db_(db),
        below_stop_(fmt::format("run_index < {}", std::min<std::uint64_t>(stop_index, kLargest))),
        kept_(below_stop_ + (folded ? " AND run_index IN (SELECT run_index FROM temp.kept)" : "")) {}

  void copy() {
    copy("runs", run_columns(), "run_index", kept_);
    copy("violations", violation_columns(), "run_index, ordinal", kept_);
    copy("incidents", kIncidentColumns, "run_index, ordinal", kept_);
    copy("probes", kProbeColumns, "run_index, ordinal", kept_);
    copy("audits", kAuditColumns, "run_index", below_stop_);
    // Runs of software that has passed its audits are replayed from their seeds. A row that is never written
    // leaves no trace in the file, one that is deleted would.
    db_.exec(fmt::format(
        "INSERT INTO recordings ({}) SELECT x.run_index, x.calls, x.checksum FROM live.recordings x JOIN main.runs r "
        "ON r.run_index = x.run_index JOIN main.cells c ON c.cell = r.cell WHERE c.agent NOT IN (SELECT agent FROM "
        "main.v1_audits GROUP BY agent HAVING min(same) = 1 AND count(*) >= {}) ORDER BY x.run_index",
        kRecordingColumns, kAuditsToPass));
  }
  const std::string& below_stop() const { return below_stop_; }

 private:
  static constexpr std::uint64_t kLargest = std::numeric_limits<std::int64_t>::max();

  void copy(const std::string& table, const std::string& columns, const std::string& key, const std::string& which) {
    db_.exec(fmt::format("INSERT INTO {0} ({1}) SELECT {1} FROM live.{0} WHERE {2} ORDER BY {3}", table, columns, which,
                         key));
  }

  SQLite::Database& db_;
  std::string below_stop_, kept_;
};

std::uint64_t checksums_digest(SQLite::Database& db, const char* checksums) {
  RowsDigest digest;
  SQLite::Statement rows(db, checksums);
  while (rows.executeStep()) digest.add(unsigned_of(rows));
  return digest.value();
}

void insert_chunks(SQLite::Database& db, const std::vector<ChunkRecord>& chunks) {
  Insert insert = insert_into(db, "main.chunks", kChunkColumns);
  for (const ChunkRecord& chunk : chunks) {
    bind_chunk(insert, chunk);
    insert.run();
  }
}

// With the count and the seal, a lost or added row and a changed view are noticed too, not only a changed row. The
// chunks are those of all runs, folded or not. `repeated_traces`: of a folded file.
void seal(SQLite::Database& db, const std::string& below_stop, std::optional<std::uint64_t> repeated_traces) {
  const auto one = [&](const char* query) { return std::bit_cast<std::uint64_t>(db.execAndGet(query).getInt64()); };
  SealedContent content(one("SELECT chunk_runs FROM main.campaign"));
  RowsDigest all;
  std::uint64_t count = 0;
  SQLite::Statement rows(db, fmt::format("SELECT checksum FROM live.runs WHERE {} ORDER BY run_index", below_stop));
  for (; rows.executeStep(); ++count) {
    content.add_run(count, unsigned_of(rows));
    all.add(unsigned_of(rows));
  }
  content.add_rest(db, kSchemaVersion);
  insert_chunks(db, content.chunks());
  std::optional<FoldedContent> fold;
  if (repeated_traces)
    fold = {content.digest(), all.value(), *repeated_traces,
            checksums_digest(db, "SELECT checksum FROM main.runs ORDER BY run_index"),
            checksums_digest(db, "SELECT checksum FROM main.folded ORDER BY place")};
  const auto seal = seal_of(schema_text(db), one("SELECT plan_checksum FROM main.campaign"), count,
                            fold ? digest_of(*fold) : content.digest());
  SQLite::Statement update(db,
                           "UPDATE main.campaign SET run_count = ?, rows_digest = ?, repeated_traces = ?, seal = ?");
  update.bind(1, static_cast<std::int64_t>(count));
  if (fold) {
    update.bind(2, std::bit_cast<std::int64_t>(fold->rows));
    update.bind(3, static_cast<std::int64_t>(fold->repeated_traces));
  }
  update.bind(4, std::bit_cast<std::int64_t>(seal));
  update.exec();
}

void remove_with_journal(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  std::filesystem::remove(path + "-journal", ignored);
}

}  // namespace

void write_canonical_file(const std::string& live_path, const std::string& target, std::uint64_t stop_index,
                          const MayFold& may_fold) {
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
    copy_plan(db);
    std::optional<std::uint64_t> repeated_traces;
    if (may_fold) repeated_traces = fold_runs(db, live_path, may_fold);
    CopiedRows rows(db, stop_index, may_fold != nullptr);
    rows.copy();
    seal(db, rows.below_stop(), repeated_traces);
    transaction.commit();
  } catch (const SQLite::Exception&) {
    remove_with_journal(target);
    throw_archive_error(target);
  }
}

}  // namespace fleetproof
