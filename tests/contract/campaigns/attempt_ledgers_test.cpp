// Every claim stands in a ledger before its first run, and the page tells the other attempts for the same release.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::attempt_ledgers_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class AttemptLedgers : public test::ProgramTest {
 protected:
  void campaign(const std::string& seed, const std::string& more = "") {
    write("c.toml", "seed = " + seed + "\nreplicates = 4\nhorizon_s = 30\n" + more +
                        "[factors]\nagents = [\"hull-lock\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]\n");
  }
  nlohmann::json attempts(const std::string& archive) {
    return nlohmann::json::parse(run("report " + archive + " --format json").out).at("attempts");
  }
};

TEST_F(AttemptLedgers, TellEveryOtherSeedThatWasTried) {
  campaign("1");
  run("run c.toml --db a.db");
  EXPECT_THAT(run("report a.db").out, HasSubstr("Earlier attempts unknown"));
  EXPECT_THAT(run("report a.db").out, Not(HasSubstr("first attempt")));
  run("run c.toml --db b.db --seed 2");
  run("run c.toml --db b.db --seed 3 --overwrite");
  const auto told = attempts("b.db");
  ASSERT_EQ(told.at("others").size(), 2U);
  EXPECT_EQ(told.at("others")[0].at("seed"), 1);
  EXPECT_EQ(told.at("others")[1].at("seed"), 2);
  EXPECT_EQ(told.at("others")[1].at("overwritten"), true);
  EXPECT_EQ(told.at("overrides"), "--seed 3");
}

TEST_F(AttemptLedgers, CountACampaignThatGoesOnOnce) {
  campaign("1");
  run("run c.toml --db a.db --replicates 2");
  run("run c.toml --db a.db");
  const auto told = attempts("a.db");
  EXPECT_TRUE(told.at("others").empty());
  EXPECT_EQ(told.at("own").at("planned_runs"), 2);
  EXPECT_EQ(told.at("own").at("runs"), 4);
  EXPECT_EQ(told.at("looks"), 2);
  EXPECT_THAT(run("report a.db").out, HasSubstr("The plan had 2 runs when it began and has 4 now"));
  EXPECT_THAT(run("report a.db --format markdown").out, HasSubstr("the number of replicates was changed since"));
}

// A number of replicates that was chosen after the results were seen.
TEST_F(AttemptLedgers, TellAnotherNumberOfReplicatesOfAFixedGate) {
  const auto with_method = [&](const std::string& method) {
    write("c.toml",
          "replicates = 4\nhorizon_s = 30\n[factors]\nagents = [\"hull-lock\"]\nlayouts = "
          "[\"aisle-grid\"]\nfleet_sizes = [2]\n[[gate]]\nagent = \"hull-lock\"\nlimit = 0.5\nmethod = \"" +
              method + "\"\n");
  };
  with_method("fixed");
  run("run c.toml --db a.db --replicates 6");
  run("run c.toml --db a.db --replicates 3 --overwrite");
  EXPECT_EQ(attempts("a.db").at("others").size(), 1U);
  EXPECT_THAT(run("report a.db --exit-zero").out, HasSubstr("The ledger names 2 attempts for this release"));
  std::filesystem::remove(path("attempts.jsonl"));
  with_method("any-time");
  run("run c.toml --db b.db --replicates 6");
  run("run c.toml --db b.db --replicates 3 --overwrite");
  EXPECT_TRUE(attempts("b.db").at("others").empty()) << "it may be stopped at any number";
}

TEST_F(AttemptLedgers, RememberACampaignThatWasKilled) {
  campaign("1");
  shell(
      "\"$FLEETPROOF\" run c.toml --db a.db --replicates 1000000 & "
      "for i in $(seq 200); do [ -s attempts.jsonl ] && break; sleep 0.1; done; kill -9 $!; wait");
  std::filesystem::remove(path("a.db"));
  run("run c.toml --db b.db --seed 2");
  const auto told = attempts("b.db").at("others");
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].at("seed"), 1);
  EXPECT_THAT(run("report b.db").out, HasSubstr("aborted or still under way"));
}

TEST_F(AttemptLedgers, OutsideTheWorkspaceSurviveIt) {
  std::filesystem::create_directory(path("kept"));
  campaign("1");
  run("run c.toml --db a.db --ledger kept/ledger.jsonl");
  std::filesystem::remove(path("a.db"));
  std::filesystem::remove(path("a.sessions.jsonl"));
  run("run c.toml --db a.db --seed 7 --ledger kept/ledger.jsonl");
  EXPECT_FALSE(std::filesystem::exists(path("attempts.jsonl")));
  EXPECT_EQ(attempts("a.db").at("others").size(), 1U) << "the session log remembers the ledger";
}

TEST_F(AttemptLedgers, OfAForeignFileRefuseTheCampaignBeforeItBegins) {
  campaign("1");
  write("attempts.jsonl", "my notes\n");
  const auto refused = run("run c.toml --db a.db");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--ledger"));
  EXPECT_FALSE(std::filesystem::exists(path("a.db")));
}

TEST_F(AttemptLedgers, StopNoReport) {
  campaign("1");
  run("run c.toml --db b.db --ledger elsewhere.jsonl");
  std::filesystem::remove(path("elsewhere.jsonl"));
  write("attempts.jsonl", "my notes\n");
  const auto told = run("report b.db");
  EXPECT_EQ(told.exit_code, 4) << told.err;
  EXPECT_THAT(told.out, HasSubstr("Earlier attempts unknown"));
  EXPECT_EQ(run("report b.db --ledger attempts.jsonl").exit_code, 2) << "it was named";
}

TEST_F(AttemptLedgers, ALookThatCannotBeCountedStopsNoReport) {
  write("c.toml",
        "seed = 1\nreplicates = 40\nhorizon_s = 300\n[factors]\nagents = [\"reckless\"]\nlayouts = "
        "[\"aisle-grid\"]\nfleet_sizes = [5]\n");
  run("run c.toml --db a.db --fail-fast 1");
  std::filesystem::remove(path("a.sessions.jsonl"));
  std::filesystem::create_directory(path("a.sessions.jsonl"));
  const auto told = run("report a.db");
  EXPECT_THAT(told.out, HasSubstr("INCOMPLETE"));
  EXPECT_THAT(told.err, HasSubstr("this look at the campaign is not counted"));
}

// The results of a campaign that still grows can be read under the name NAME.partial.
TEST_F(AttemptLedgers, ALookAtARunningCampaignCounts) {
  campaign("1");
  shell(
      "\"$FLEETPROOF\" run c.toml --db a.db --replicates 1000000 & "
      "for i in $(seq 200); do [ -s a.sessions.jsonl ] && break; sleep 0.1; done; sleep 2; kill -9 $!; wait");
  ASSERT_TRUE(std::filesystem::exists(path("a.db.partial")));
  const auto told = attempts("a.db.partial");
  EXPECT_EQ(told.at("looks"), 1);
  EXPECT_EQ(told.at("overrides"), "--replicates 1000000");
}

TEST_F(AttemptLedgers, AnEndingThatIsNotOursBelongsToTheName) {
  campaign("1");
  run("run c.toml --db plant-1.1 --seed 5");
  run("run c.toml --db plant-1.2 --seed 6");
  EXPECT_EQ(attempts("plant-1.1").at("overrides"), "--seed 5");
  EXPECT_EQ(attempts("plant-1.2").at("overrides"), "--seed 6");
}

TEST_F(AttemptLedgers, AFreshSeedFollowsFromReleaseAndPlan) {
  campaign("\"fresh\"");
  run("run c.toml --db a.db");
  run("run c.toml --db b.db --replicates 5");
  const auto a = attempts("a.db").at("own"), b = attempts("b.db").at("own");
  EXPECT_EQ(a.at("fresh_seed"), true);
  EXPECT_EQ(a.at("seed"), b.at("seed")) << "more replicates of the same worlds";
  campaign("\"fresh\"", "stuck_after_s = 100\n");
  run("run c.toml --db c.db");
  EXPECT_NE(attempts("c.db").at("own").at("seed"), a.at("seed"));
  EXPECT_THAT(run("report a.db").out, HasSubstr("follows from the digests of release and plan."));
  EXPECT_THAT(run("run c.toml --db d.db --seed 5").err, Not(HasSubstr("error")));
  EXPECT_EQ(attempts("d.db").at("own").at("fresh_seed"), false);
}

TEST_F(AttemptLedgers, ARefusedSeedNamesTheWord) {
  campaign("\"frsh\"");
  const auto refused = run("run c.toml --db a.db");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("seed"));
}

TEST_F(AttemptLedgers, ASearchClaimsNothing) {
  campaign("1", "kind = \"search\"\n");
  run("run c.toml --db a.db");
  EXPECT_FALSE(std::filesystem::exists(path("attempts.jsonl")));
}

}  // namespace
}  // namespace fleetproof::attempt_ledgers_test
