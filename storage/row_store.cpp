#include "storage/row_store.hpp"

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Statement.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "storage/checksum.hpp"
#include "storage/rows.hpp"
#include "storage/schema.hpp"
#include "storage/statement.hpp"

namespace fleetproof {
namespace {

// Of all recordings in a file. Beyond it runs are stored without theirs, or an agent that fails in every run would fill
// the disk.
constexpr std::int64_t kRecordingBytesMax = std::int64_t{1} << 30;

// Inserts the violations, incidents or probes of a run, several with one statement: running a statement costs as much
// as binding a dozen values. OR FAIL: without it, SQLite copies each page before the statement writes to it, so that an
// error undoes the rows before. After an error the writer drops the whole transaction.
template <class Part>
class PartsInsert {
 public:
  using Bind = void (*)(Insert&, int first, const Part&);

  // The first two columns are the run index and the ordinal.
  PartsInsert(SQLite::Database& db, std::string table, std::string columns, Bind bind)
      : db_(db), table_(std::move(table)), columns_(std::move(columns)), bind_(bind) {}

  void insert(std::uint64_t run_index, const std::vector<Part>& parts) {
    for (std::size_t done = 0; done < parts.size();) {
      const std::size_t rows = std::min(parts.size() - done, inserts_.size());
      Insert& insert = insert_of(rows);
      insert.bind(1, std::bit_cast<std::int64_t>(run_index));
      insert.bind(2, static_cast<std::int64_t>(done));
      for (std::size_t row = 0; row < rows; ++row, ++done)
        bind_(insert, 3 + static_cast<int>(row) * own_columns_, parts[done]);
      insert.run();
    }
  }

 private:
  Insert& insert_of(std::size_t rows) {
    auto& insert = inserts_[rows - 1];
    if (!insert) {
      std::string values, own;
      for (int i = 0; i < own_columns_; ++i) own += ", ?";
      for (std::size_t row = 0; row < rows; ++row)
        values += fmt::format("{}(?1, ?2 + {}{})", row == 0 ? "" : ", ", row, own);
      insert.emplace(db_, fmt::format("INSERT OR FAIL INTO {} ({}) VALUES {}", table_, columns_, values));
    }
    return *insert;
  }

  SQLite::Database& db_;
  const std::string table_, columns_;
  const Bind bind_;
  const int own_columns_ = static_cast<int>(std::ranges::count(columns_, ',')) - 1;
  std::array<std::optional<Insert>, 16> inserts_;  // by their number of rows
};

std::string insert_new_run() {
  const std::string columns = run_columns();
  return fmt::format("INSERT INTO runs ({}) VALUES ({}) ON CONFLICT (run_index) DO NOTHING", columns,
                     placeholders(columns));
}

}  // namespace

struct RowStore::Statements {
  Insert insert_run, insert_recording, insert_audit;
  SQLite::Statement stored_checksum;
  PartsInsert<Violation> violations;
  PartsInsert<Incident> incidents;
  PartsInsert<ProbeCount> probes;
  std::int64_t recording_bytes;

  explicit Statements(SQLite::Database& db)
      : insert_run(db, insert_new_run()),
        insert_recording(insert_into(db, "recordings", kRecordingColumns)),
        insert_audit(insert_into(db, "audits", kAuditColumns)),
        stored_checksum(db, "SELECT checksum FROM runs WHERE run_index = ?"),
        violations(db, "violations", violation_columns(), bind_violation),
        incidents(db, "incidents", kIncidentColumns, bind_incident),
        probes(db, "probes", kProbeColumns, bind_probe),
        recording_bytes(db.execAndGet("SELECT coalesce(sum(length(calls)), 0) FROM recordings").getInt64()) {}

  bool is_stored(const RunRecord& run, std::uint64_t checksum) {
    stored_checksum.reset();
    stored_checksum.bind(1, static_cast<std::int64_t>(run.run_index));
    const bool same = stored_checksum.executeStep() &&
                      std::bit_cast<std::uint64_t>(stored_checksum.getColumn(0).getInt64()) == checksum;
    stored_checksum.reset();
    return same;
  }

  void add_recording(const RunRecord& run) {
    const auto size = static_cast<std::int64_t>(run.recording.size());
    if (size == 0 || recording_bytes + size > kRecordingBytesMax) return;
    recording_bytes += size;
    bind_recording(insert_recording, run.run_index, run.recording, recording_checksum(run.recording));
    insert_recording.run();
  }
};

RowStore::RowStore(SQLite::Database& db) : statements_(std::make_unique<Statements>(db)) {}
RowStore::~RowStore() = default;

bool RowStore::add(const RunRecord& run) {
  Statements& to = *statements_;
  const auto checksum = row_checksum(run);
  bind_run(to.insert_run, run, checksum);
  if (to.insert_run.run() != 1) return to.is_stored(run, checksum);
  to.violations.insert(run.run_index, run.outcome.violations);
  to.incidents.insert(run.run_index, run.outcome.incidents);
  to.probes.insert(run.run_index, run.outcome.probes);
  to.add_recording(run);
  return true;
}

void RowStore::add(const AuditRecord& audit) {
  bind_audit(statements_->insert_audit, audit);
  statements_->insert_audit.run();
}

}  // namespace fleetproof
