// A results file is checked against the runs themselves: rows that cannot be reproduced are found, and the cause is
// named.
#include <gmock/gmock.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "campaign/batch/stored_plan.hpp"
#include "campaign/batch/verification.hpp"
#include "campaign/run/sha256.hpp"
#include "core/base/error.hpp"
#include "reports/evidence/quiet_run.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "tests/contract/campaigns/small_campaign.hpp"
#include "tests/support/program.hpp"

namespace fleetproof::verify_test {
namespace {

using testing::HasSubstr;

class Verify : public test::ProgramTest {
 protected:
  // Writes a campaign with valid checksums, as if `program_sha256` had computed these rows.
  void write_archive(const std::string& program_sha256, const std::function<void(RunRecord&)>& change,
                     const MayFold& may_fold = {}) {
    const AgentPrograms programs;
    CampaignRecord record = campaign_record(plan_, programs);
    record.engine.program_sha256 = program_sha256;
    ArchiveWriter writer(path("v.db"), {record, plan_.cells(), plan_.gates}, Existing::Replace);
    const RunOne run_one(plan_, programs);
    for (std::uint64_t index = 0; index < plan_.run_count(); ++index) {
      RunRecord run = run_one(index);
      change(run);
      writer.add(run);
    }
    writer.publish(plan_.run_count(), may_fold);
  }
  // Some run in which nothing went wrong is folded and was stored with another counter. Returns its number.
  std::string write_wrong_folded_run(const std::string& program_sha256) {
    plan_.keep = Keep::Failing;
    write_archive(
        program_sha256, [](RunRecord&) {}, is_quiet);
    std::uint64_t wrong = plan_.run_count();
    while (wrong-- > 0 && !ArchiveReader(path("v.db")).folded_run(wrong)) continue;
    write_archive(
        program_sha256, [&](RunRecord& run) { run.outcome.counters.turns ^= run.run_index == wrong ? 1 : 0; },
        is_quiet);
    EXPECT_TRUE(ArchiveReader(path("v.db")).folded_run(wrong));
    return std::to_string(wrong);
  }
  static void change_run_17(RunRecord& run) {
    if (run.run_index == 17) run.outcome.counters.turns ^= 1;
  }

  CampaignPlan plan_ = test::small_plan();
  const std::string this_program_ = sha256_of_file(FLEETPROOF_PROGRAM);
};

TEST_F(Verify, AllRunsOfAnHonestFileAgree) {
  write_archive(this_program_, [](RunRecord&) {});
  const auto finished = run("verify v.db --sample 100% --jobs 3");
  EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
  EXPECT_EQ(finished.out, "v.db: 72 runs, every checksum holds; 72 simulated again: 72 agree, 0 differ\n");
  EXPECT_THAT(run("verify v.db").out, HasSubstr("1 simulated again: 1 agree"));
  EXPECT_THAT(run("verify v.db --sample 1000").out, HasSubstr("72 simulated again"));
  const auto json = nlohmann::json::parse(run("verify v.db --sample 10 --json").out);
  EXPECT_EQ(json["agree"], 10);
  EXPECT_EQ(json["differ"].size(), 0U);
}

TEST_F(Verify, AWrongRowOfTheSameProgramIsItsFault) {
  write_archive(this_program_, change_run_17);
  const auto finished = run("verify v.db --sample 100%");
  EXPECT_EQ(finished.exit_code, 3) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("DIVERGED  run 17: "));
  EXPECT_THAT(finished.out, HasSubstr("fleetproof replay v.db 17"));
  EXPECT_THAT(finished.out, HasSubstr("71 agree, 1 differ"));
  const auto json = nlohmann::json::parse(run("verify v.db --sample 100% --json").out);
  ASSERT_EQ(json["differ"].size(), 1U);
  EXPECT_EQ(json["differ"][0]["run"], 17);
  EXPECT_EQ(json["differ"][0]["engine_at_fault"], true);
}

TEST_F(Verify, AnotherRowOfAnotherProgramIsOtherSoftware) {
  write_archive("another", change_run_17);
  const auto finished = run("verify v.db --sample 100%");
  EXPECT_EQ(finished.exit_code, 4) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("SOFTWARE DIFFERS  run 17: "));
  EXPECT_THAT(finished.out, HasSubstr("sha256 another then"));
}

TEST_F(Verify, AWrongFoldedRunOfTheSameProgramIsItsFault) {
  const std::string wrong = write_wrong_folded_run(this_program_);
  const auto replayed = run("replay v.db " + wrong);
  EXPECT_EQ(replayed.exit_code, 3) << replayed.out << replayed.err;
  EXPECT_THAT(replayed.out, HasSubstr("kept of its checksum do not match"));
  const auto verified = run("verify v.db --sample 100%");
  EXPECT_EQ(verified.exit_code, 3) << verified.out << verified.err;
  EXPECT_THAT(verified.out, HasSubstr("DIVERGED  run " + wrong + ": "));
  EXPECT_THAT(verified.out, HasSubstr("71 agree, 1 differ"));
}

TEST_F(Verify, AWrongFoldedRunOfAnotherProgramIsOtherSoftware) {
  const std::string wrong = write_wrong_folded_run("another");
  const auto replayed = run("replay v.db " + wrong);
  EXPECT_EQ(replayed.exit_code, 4) << replayed.out << replayed.err;
  EXPECT_THAT(replayed.out, HasSubstr("kept of its checksum do not match"));
  const auto verified = run("verify v.db --sample 100%");
  EXPECT_EQ(verified.exit_code, 4) << verified.out << verified.err;
  EXPECT_THAT(verified.out, HasSubstr("71 agree, 1 differ"));
}

TEST_F(Verify, ADamagedRowOutsideTheSampleIsFound) {
  write_archive(this_program_, [](RunRecord&) {});
  std::string bytes = read(path("v.db"));
  const auto at = bytes.rfind("\x04\x04\x04");
  const std::size_t place = at == std::string::npos ? bytes.size() - 1000 : at;
  bytes[place] = static_cast<char>(bytes[place] ^ 0x10);
  write("v.db", bytes);
  const auto finished = run("verify v.db --sample 1");
  EXPECT_EQ(finished.exit_code, 3) << finished.out << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("damaged"));
}

TEST_F(Verify, PluginsAreThoseThatTheSessionRemembers) {
  std::filesystem::copy_file(FLEETPROOF_FAILING_AGENT, path("failing.so"));
  write("c.toml",
        "name = \"c\"\nkind = \"search\"\nreplicates = 40\nhorizon_s = 60\nagent_config = \"mixed 5\"\n[factors]\n"
        "agents = [{ file = \"failing.so\", name = \"candidate\" }, \"reckless\"]\nlayouts = [\"aisle-grid\"]\n");
  ASSERT_THAT(run("run c.toml --db c.db").exit_code, testing::AnyOf(1, 4));
  const auto finished = run("verify c.db --sample 100%");
  EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("80 agree"));
  const auto rebuilt = shell("FLEETPROOF_TEST_REBUILT=yes \"$FLEETPROOF\" verify c.db --sample 100%");
  EXPECT_EQ(rebuilt.exit_code, 3) << "the agent promises to do the same twice, and its audits bear that out";
  EXPECT_THAT(rebuilt.out, HasSubstr("DIVERGED"));
  EXPECT_THAT(rebuilt.out, Not(HasSubstr("reckless: trace digest")));
  std::filesystem::remove(path("c.sessions.jsonl"));
  const auto unknown = run("verify c.db");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--plugin"));
  EXPECT_EQ(run("verify c.db --plugin failing.so").exit_code, 0);
}

TEST(SampleOfRuns, IsKeyedSpreadAndOfTheSizeAskedFor) {
  const auto sample = sample_of_runs(5, 1000, 10);
  ASSERT_EQ(sample.size(), 10U);
  for (std::size_t i = 0; i < sample.size(); ++i) EXPECT_EQ(sample[i] / 100, i);
  EXPECT_EQ(sample_of_runs(5, 1000, 10), sample);
  EXPECT_NE(sample_of_runs(6, 1000, 10), sample);
  EXPECT_EQ(sample_of_runs(5, 3, 3), (std::vector<std::uint64_t>{0, 1, 2}));
  EXPECT_EQ(sample_of_runs(5, 7, 4).back(), 6U) << "the last episode of 7 runs in 4 is one run long";
  EXPECT_TRUE(sample_of_runs(5, 0, 0).empty());
}

TEST(SampleOfRuns, EveryRunHasItsChance) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t key = 0; key < 500; ++key) seen.insert(sample_of_runs(key, 20, 3).at(1));
  EXPECT_EQ(seen, (std::set<std::uint64_t>{7, 8, 9, 10, 11, 12, 13}));
}

TEST(SampleSize, IsAShareOrANumber) {
  EXPECT_EQ(sample_size("1%", 4608), 47U);
  EXPECT_EQ(sample_size("0.5%", 1000), 5U);
  EXPECT_EQ(sample_size("7%", 100), 7U);
  EXPECT_EQ(sample_size("1%", 3), 1U);
  EXPECT_EQ(sample_size("100%", 77), 77U);
  EXPECT_EQ(sample_size("200", 77), 77U);
  EXPECT_EQ(sample_size("20", 77), 20U);
  EXPECT_EQ(sample_size("1%", 0), 0U);
  for (const char* wrong : {"", "%", "0", "0%", "101%", "-3", "2.5", "1e3", "nan", "inf", "ten", "5%%", "5 %"})
    EXPECT_THROW(sample_size(wrong, 100), InputError) << wrong;
}

}  // namespace
}  // namespace fleetproof::verify_test
