// Results files of earlier versions of this program: archives/schema4.fp to schema13.fp. The programs of
// their time wrote them, from one campaign file with a call cost of 10 ms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "storage/checksum.hpp"
#include "storage/schema.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::older_schemas_test {
namespace {

using samples::TemporaryFolder;

constexpr std::uint64_t kRuns = 12;

void execute(const std::string& path, const std::string& sql) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
  sqlite3_close(db);
}

std::vector<RunRecord> runs_of(const std::string& path) {
  std::vector<RunRecord> runs;
  ArchiveReader(path).for_each_run([&](const RunRecord& run) { runs.push_back(run); });
  return runs;
}

std::vector<std::pair<AuditRecord, bool>> audits_of(const std::string& path) {
  std::vector<std::pair<AuditRecord, bool>> audits;
  ArchiveReader(path).for_each_audit([&](const AuditRecord& audit, bool same) { audits.emplace_back(audit, same); });
  return audits;
}

// As a killed program leaves it: without a seal.
std::string unsealed(int schema) {
  return "PRAGMA journal_mode = WAL; UPDATE campaign SET run_count = NULL, " +
         std::string(schema < kFirstSealed ? "rows_digest" : "seal") + " = NULL";
}

void go_on(const std::string& path, std::uint64_t& taken_over) {
  CampaignRecord campaign;
  std::vector<CellRecord> cells;
  std::vector<GateRecord> gates;
  {
    const ArchiveReader reader(std::filesystem::exists(path) ? path : path + ".partial");
    campaign = reader.campaign();
    cells = reader.cells();
    gates = reader.gates();
  }
  Resumption resumption;
  resumption.visit = [&](const RunRecord&) { ++taken_over; };
  ArchiveWriter(path, {campaign, cells, gates}, Existing::Resume, resumption).publish(kRuns);
}

class OlderSchemas : public testing::TestWithParam<int> {
 protected:
  OlderSchemas() {
    samples::write_bytes(path_,
                         samples::bytes_of(std::string(FLEETPROOF_SOURCE_DIR) + "/tests/storage/archives/schema" +
                                           std::to_string(GetParam()) + ".fp"));
  }
  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "a.fp";
};

// Earlier ones have no audits and no recordings.
class ChunkedSchemas : public OlderSchemas {};

TEST_P(OlderSchemas, AreRead) {
  const ArchiveReader reader(path_);
  EXPECT_EQ(reader.schema(), GetParam());
  EXPECT_EQ(reader.campaign().name, "old");
  ASSERT_EQ(reader.gates().size(), 1U);
  EXPECT_EQ(reader.gates()[0].method, GateMethod::Fixed) << "the rule of their time";
  EXPECT_TRUE(reader.gates()[0].decides);
  EXPECT_EQ(reader.gates()[0].where, CellFilter{}) << "all cells of the region";
  ASSERT_EQ(reader.cells().size(), 4U);
  EXPECT_EQ(reader.cells()[3].lowest[Factor::Loss], 0.4);
  for (const auto& cell : reader.cells()) {
    EXPECT_EQ(cell.lowest[Factor::CallCost], 0.01) << "schema 4 has it in the plan only";
    EXPECT_EQ(cell.highest[Factor::CallCost], 0.01);
  }
  const auto runs = runs_of(path_);
  ASSERT_EQ(runs.size(), kRuns);
  for (const auto& run : runs) EXPECT_EQ(run.factors[Factor::CallCost], 0.01);
  EXPECT_EQ(reader.run(7)->outcome, runs[7].outcome);
  EXPECT_EQ(runs[7].outcome.counters.events, 88U);  // as the sqlite3 program reads it
}

TEST_P(OlderSchemas, AreCheckedByTheRulesOfTheirTime) {
  const std::string whole = samples::bytes_of(path_);
  for (const char* change :
       {"UPDATE runs SET transports_done = transports_done + 1 WHERE run_index = 3", "UPDATE cells SET loss = 0.1",
        "UPDATE campaign SET run_count = 11", "UPDATE campaign SET run_count = NULL", "PRAGMA user_version = 14",
        "DELETE FROM runs WHERE run_index = 11; DELETE FROM violations WHERE run_index = 11; DELETE FROM incidents "
        "WHERE "
        "run_index = 11; DELETE FROM probes WHERE run_index = 11"}) {
    samples::write_bytes(path_, whole);
    execute(path_, change);
    EXPECT_THROW(runs_of(path_), EngineError) << change;
  }
  samples::write_bytes(path_, whole);
  execute(path_, "PRAGMA user_version = 3");
  EXPECT_THROW(runs_of(path_), InputError);
}

TEST_P(OlderSchemas, GoOnInTheSchemaOfToday) {
  const auto before = runs_of(path_);
  std::uint64_t taken_over = 0;
  go_on(path_, taken_over);
  EXPECT_EQ(taken_over, kRuns);
  EXPECT_EQ(ArchiveReader(path_).schema(), kSchemaVersion);
  const auto after = runs_of(path_);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].outcome, before[i].outcome);
    EXPECT_EQ(after[i].factors, before[i].factors);
  }
  const auto bytes = samples::bytes_of(path_);
  go_on(path_, taken_over);
  EXPECT_TRUE(samples::bytes_of(path_) == bytes);
}

// What was simulated again, and what agents did, is not forgotten.
TEST_P(ChunkedSchemas, GoOnWithTheirAuditsAndRecordings) {
  const std::string live = path_ + ".partial", calls = "what the agents did";
  std::filesystem::rename(path_, live);
  execute(live, unsealed(GetParam()) +
                    "; UPDATE audits SET checksum = 17 WHERE run_index = (SELECT max(run_index) FROM audits)" +
                    "; INSERT INTO recordings (run_index, calls, checksum) VALUES (7, CAST('" + calls + "' AS BLOB), " +
                    std::to_string(static_cast<std::int64_t>(recording_checksum(calls))) + ")");
  const auto before = audits_of(live);
  ASSERT_EQ(before.size(), 2U);
  ASSERT_TRUE(before[0].second && !before[1].second);
  std::uint64_t taken_over = 0;
  go_on(path_, taken_over);
  const auto after = audits_of(path_);
  ASSERT_EQ(after.size(), 2U);
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].first.run_index, before[i].first.run_index);
    EXPECT_EQ(after[i].second, before[i].second);
  }
  EXPECT_EQ(after[1].first.checksum, 17U);
  EXPECT_EQ(ArchiveReader(path_).recording(7), calls);
}

// The log of the old file must not be taken for that of the new one.
TEST_P(OlderSchemas, GoOnFromALiveFileWithALog) {
  std::uint64_t taken_over = 0;
  go_on(path_, taken_over);
  const auto wanted = samples::bytes_of(path_);
  const std::string other = folder_ / "b.fp";
  const std::string old = folder_ / "old.db";
  samples::write_bytes(old, samples::bytes_of(std::string(FLEETPROOF_SOURCE_DIR) + "/tests/storage/archives/schema" +
                                              std::to_string(GetParam()) + ".fp"));
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(old.c_str(), &db), SQLITE_OK);
  const std::string sql = unsealed(GetParam()) + "; UPDATE runs SET checksum = checksum";
  EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  for (const auto* suffix : {"", "-wal"})
    samples::write_bytes(other + ".partial" + suffix, samples::bytes_of(old + suffix));  // as after a kill
  sqlite3_close(db);
  ASSERT_GT(samples::bytes_of(other + ".partial-wal").size(), 4096U);
  taken_over = 0;
  go_on(other, taken_over);
  EXPECT_EQ(taken_over, kRuns);
  EXPECT_TRUE(samples::bytes_of(other) == wanted);
  EXPECT_FALSE(std::filesystem::exists(other + ".partial-wal"));
}

// A folded file that does not say which runs repeat others, with a gate in AGV-hours.
TEST(FoldedFileOfSchema11, IsReadAndCannotGoOn) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fp";
  samples::write_bytes(
      path, samples::bytes_of(std::string(FLEETPROOF_SOURCE_DIR) + "/tests/storage/archives/schema11-folded.fp"));
  const ArchiveReader reader(path);
  EXPECT_EQ(reader.schema(), 11);
  EXPECT_TRUE(reader.is_folded());
  EXPECT_EQ(reader.unplaced_repeats(), 22U) << "twelve runs of each of two cells, all alike";
  EXPECT_EQ(runs_of(path).size(), 24U);
  std::uint64_t quiet_runs = 0;
  reader.for_each_run([](const RunRecord&) {},
                      {.met = {}, .quiet = [&](const QuietReplicates& quiet) { quiet_runs += 2 * quiet.replicates; }});
  EXPECT_EQ(quiet_runs, 22U);
  std::uint64_t taken_over = 0;
  EXPECT_THROW(go_on(path, taken_over), InputError);
}

INSTANTIATE_TEST_SUITE_P(Each, OlderSchemas, testing::Range(4, kSchemaVersion));
INSTANTIATE_TEST_SUITE_P(Each, ChunkedSchemas, testing::Range(kFirstChunked, kSchemaVersion));

}  // namespace
}  // namespace fleetproof::older_schemas_test
