// Audits, recordings and chunks in a results file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "storage/checksum.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::sealed_content_test {
namespace {

using testing::ElementsAre;
using testing::Pair;

constexpr std::uint64_t kRuns = 30;

class SealedFile : public testing::Test {
 protected:
  SealedFile() { campaign_.chunk_runs = 8; }

  // Run 3 and, if `steady`, each run is audited and came out the same. If not, run 9 came out differently.
  void make(const std::string& path, std::uint64_t count, bool steady) {
    ArchiveWriter writer(path, {campaign_, samples::cells(), {}});
    for (RunRecord run : samples::runs(count)) {
      if (run.run_index % 5 == 0) run.recording = "what agents did in run " + std::to_string(run.run_index);
      writer.add(run);
      if (steady || run.run_index == 3) writer.add(AuditRecord{run.run_index, row_checksum(run), audited_outcome(run)});
      if (!steady && run.run_index == 9) writer.add(AuditRecord{9, row_checksum(run) + 1, audited_outcome(run)});
    }
    writer.publish(count);
  }
  std::string query(const std::string& sql, const std::string& path = "") {
    std::string text;
    sqlite3* db = nullptr;
    EXPECT_EQ(sqlite3_open((path.empty() ? path_ : path).c_str(), &db), SQLITE_OK);
    const auto collect = [](void* all, int count, char** values, char**) {
      for (int i = 0; i < count; ++i) *static_cast<std::string*>(all) += std::string(values[i]) + " ";
      return 0;
    };
    EXPECT_EQ(sqlite3_exec(db, sql.c_str(), collect, &text, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
    sqlite3_close(db);
    return text;
  }

  const samples::TemporaryFolder folder_;
  const std::string path_ = folder_ / "a.fp";
  CampaignRecord campaign_ = samples::campaign();
};

TEST_F(SealedFile, AuditsAndRecordingsComeBack) {
  make(path_, kRuns, false);
  const ArchiveReader reader(path_);
  std::vector<std::pair<std::uint64_t, bool>> audits;
  const auto runs = samples::runs(kRuns);
  reader.for_each_audit([&](const AuditRecord& audit, bool same) {
    audits.emplace_back(audit.run_index, same);
    EXPECT_EQ(audit.outcome, audited_outcome(runs[audit.run_index]));
  });
  EXPECT_THAT(audits, ElementsAre(Pair(3, true), Pair(9, false)));
  EXPECT_EQ(reader.recording(5), "what agents did in run 5");
  EXPECT_EQ(reader.recording(6), std::nullopt);
  EXPECT_EQ(reader.recording_count("sound"), 6U);
  EXPECT_EQ(query("SELECT run_index, same FROM v1_audits"), "3 1 9 0 ");
}

TEST_F(SealedFile, RecordingsOfAnAgentThatIsTheSameInEveryAuditAreLeftOut) {
  make(path_, kRuns, true);
  EXPECT_EQ(ArchiveReader(path_).recording_count("sound"), 0U);
  const std::string without = folder_ / "without.fp";
  ArchiveWriter writer(without, {campaign_, samples::cells(), {}});
  for (const RunRecord& run : samples::runs(kRuns)) {
    writer.add(run);
    writer.add(AuditRecord{run.run_index, row_checksum(run), audited_outcome(run)});
  }
  writer.publish(kRuns);
  EXPECT_TRUE(samples::bytes_of(without) == samples::bytes_of(path_));
  make(folder_ / "few.fp", kAuditsToPass - 1, true);
  EXPECT_EQ(ArchiveReader(folder_ / "few.fp").recording_count("sound"), 4U) << "too few audits";
}

TEST_F(SealedFile, AFullChunkKeepsItsDigestWhenTheCampaignGrows) {
  const std::string shorter = folder_ / "shorter.fp";
  make(shorter, 20, true);
  make(path_, kRuns, true);
  const std::string full =
      "SELECT chunk, run_count, digest FROM chunks WHERE run_count = 8 AND chunk < 2 ORDER BY chunk";
  EXPECT_EQ(query(full), query(full, shorter));
  EXPECT_EQ(query("SELECT chunk, run_count FROM chunks"), "0 8 1 8 2 8 3 6 ");
  EXPECT_EQ(query("SELECT chunk, run_count FROM chunks", shorter), "0 8 1 8 2 4 ");
  EXPECT_NE(query("SELECT digest FROM chunks WHERE chunk = 0"), query("SELECT digest FROM chunks WHERE chunk = 1"));
}

TEST_F(SealedFile, AChangeOfAnAuditARecordingOrAChunkIsNoticed) {
  make(path_, kRuns, false);
  const std::string whole = samples::bytes_of(path_);
  for (const char* change :
       {"UPDATE audits SET checksum = checksum + 1 WHERE run_index = 3", "DELETE FROM audits WHERE run_index = 9",
        "UPDATE audits SET run_index = 4 WHERE run_index = 3",
        "UPDATE audits SET failed = failed + 1 WHERE run_index = 3", "UPDATE audits SET transports_done = NULL",
        "UPDATE audits SET failed = NULL", "UPDATE runs SET failed = 4095", "UPDATE runs SET unknown = failed",
        "UPDATE recordings SET calls = x'00' WHERE run_index = 5", "DELETE FROM recordings WHERE run_index = 10",
        "UPDATE chunks SET digest = digest + 1 WHERE chunk = 1", "DELETE FROM chunks WHERE chunk = 3",
        "UPDATE campaign SET chunk_runs = 16", "UPDATE campaign SET chunk_runs = 0"}) {
    samples::write_bytes(path_, whole);
    query(change);
    EXPECT_THROW(ArchiveReader(path_).for_each_run([](const RunRecord&) {}), EngineError) << change;
  }
  samples::write_bytes(path_, whole);
  query("UPDATE recordings SET calls = x'00' WHERE run_index = 5");
  EXPECT_THROW((void)ArchiveReader(path_).recording(5), EngineError);
}

TEST_F(SealedFile, ASessionThatGoesOnSeesTheAuditsOfTheOneBefore) {
  make(path_, kRuns, false);
  std::vector<std::pair<std::uint64_t, bool>> seen;
  Resumption resumption;
  resumption.visit_audit = [&](const AuditRecord& audit, bool same) { seen.emplace_back(audit.run_index, same); };
  ArchiveWriter writer(path_, {campaign_, samples::cells(), {}}, Existing::Resume, resumption);
  EXPECT_THAT(seen, ElementsAre(Pair(3, true), Pair(9, false)));
  const std::string before = samples::bytes_of(path_);
  writer.publish(kRuns);
  EXPECT_TRUE(samples::bytes_of(path_) == before);
}

}  // namespace
}  // namespace fleetproof::sealed_content_test
