// Every failing run comes back to the bit, and a file that was tampered with says so.
#include "campaign/run/replay.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "campaign/run/sha256.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::replay_test {
namespace {

using testing::HasSubstr;

class Replay : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    const AgentPrograms programs;
    RunOptions options;
    options.workers = 2;
    run_campaign(test::small_plan(), programs, path("c.db"), options, {});
    const ArchiveReader archive(path("c.db"));
    archive.for_each_run([&](const RunRecord& record) {
      if (record.outcome.violation) violating_.push_back(record.run_index);
    });
    ASSERT_FALSE(violating_.empty());
  }

  test::Finished tampered(const std::string& sql) {
    std::filesystem::copy_file(path("c.db"), path("t.db"), std::filesystem::copy_options::overwrite_existing);
    {
      SQLite::Database db(path("t.db"), SQLite::OPEN_READWRITE);
      // As if the program itself had written the file, and not this test.
      db.exec("UPDATE campaign SET program_sha256 = '" + sha256_of_file(FLEETPROOF_PROGRAM) + "'");
      EXPECT_GE(db.exec(sql), 1) << sql;
    }
    return run("replay t.db " + std::to_string(violating_[0]));
  }

  std::vector<std::uint64_t> violating_;
};

TEST_F(Replay, EveryViolatingRunIsReproduced) {
  const ArchiveReader archive(path("c.db"));
  const AgentPrograms programs;
  for (const std::uint64_t index : violating_) {
    const auto result = replay(archive, index, programs);
    EXPECT_EQ(result.verdict, ReplayVerdict::Reproduced) << index << ": " << result.explanation;
  }
  const auto finished = run("replay c.db " + std::to_string(violating_[0]));
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("REPRODUCED"));
  EXPECT_THAT(finished.out, HasSubstr("closer than 0.10 m"));
}

TEST_F(Replay, AnotherOutcomeOfAnotherProgramIsNoFaultOfTheEngine) {
  SQLite::Database(path("c.db"), SQLite::OPEN_READWRITE).exec("UPDATE runs SET digest = digest + 1");
  const auto finished = run("replay c.db " + std::to_string(violating_[0]));
  EXPECT_EQ(finished.exit_code, 4) << "this test wrote the file, the program replays it";
  EXPECT_THAT(finished.out, HasSubstr("SOFTWARE DIFFERS"));
  EXPECT_THAT(finished.out, HasSubstr("the software differs (fleetproof "));
  EXPECT_THAT(finished.out, HasSubstr("stored outcome: contact"));
}

TEST_F(Replay, AChangedDigestDiverges) {
  const auto finished =
      tampered("UPDATE runs SET digest = digest + 1 WHERE run_index = " + std::to_string(violating_[0]));
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_THAT(finished.out, HasSubstr("DIVERGED"));
  EXPECT_THAT(finished.out, HasSubstr("trace digest"));
}

TEST_F(Replay, AChangedScenarioDigestDiverges) {
  const auto finished = tampered("UPDATE runs SET scenario_digest = scenario_digest + 1 WHERE run_index = " +
                                 std::to_string(violating_[0]));
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_THAT(finished.out, HasSubstr("DIVERGED"));
  EXPECT_THAT(finished.out, HasSubstr("the scenario differs"));
}

TEST_F(Replay, AChangedSeedOrScenarioValueDiverges) {
  for (const char* change : {"replace(plan_json, '\"seed\": 77', '\"seed\": 78')",
                             "replace(plan_json, '\"width_m\": 1.0', '\"width_m\": 1.1')",
                             "replace(plan_json, '\"horizon_s\": 120.0', '\"horizon_s\": 121.0')"}) {
    const auto finished =
        tampered(std::string("UPDATE campaign SET plan_json = ") + change + " WHERE plan_json <> " + change);
    EXPECT_EQ(finished.exit_code, 3) << change << finished.err;
    EXPECT_THAT(finished.out, HasSubstr("DIVERGED")) << change;
    EXPECT_THAT(finished.out, HasSubstr("the plan in the file was changed")) << change;
  }
}

TEST_F(Replay, AChangedViolationDiverges) {
  const auto finished = tampered("UPDATE violations SET min_clearance_um = min_clearance_um - 1 WHERE run_index = " +
                                 std::to_string(violating_[0]));
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_THAT(finished.out, HasSubstr("DIVERGED"));
  EXPECT_THAT(finished.out, HasSubstr("violation 0"));
}

TEST_F(Replay, AReportOfATamperedFileIsRefused) {
  tampered("UPDATE runs SET contact = 1 - contact WHERE run_index = " + std::to_string(violating_[0]));
  const auto finished = run("report t.db");
  EXPECT_EQ(finished.exit_code, 3);
  EXPECT_THAT(finished.err, HasSubstr("damaged"));
}

TEST_F(Replay, TheScenarioOfARunStandsOnItsOwn) {
  const std::string index = std::to_string(violating_[0]);
  ASSERT_EQ(run("replay c.db " + index + " --scenario case.json").exit_code, 0);
  const ArchiveReader archive(path("c.db"));
  const auto record = archive.run(violating_[0]);
  const std::string agent = archive.cells()[record->cell].agent;
  const auto finished = run("simulate case.json --agent " + agent + " --json");
  EXPECT_EQ(finished.exit_code, 1) << finished.err;
  char digest[17];
  std::snprintf(digest, sizeof digest, "%016llx", static_cast<unsigned long long>(record->outcome.digest));
  EXPECT_THAT(finished.out, HasSubstr(digest));
}

}  // namespace
}  // namespace fleetproof::replay_test
