// What CI machines read, and the stop as soon as there is a verdict.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::ci_summary_test {
namespace {

using testing::HasSubstr;

class InCi : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("c.toml", campaign("reckless", 0.1));
  }
  void TearDown() override {
    ::unsetenv("GITHUB_STEP_SUMMARY");
    ::unsetenv("GITHUB_ACTIONS");
    ProgramTest::TearDown();
  }
  static std::string campaign(const std::string& agent, double limit, const std::string& method = "any-time") {
    return fmt::format(
        "replicates = 400\nhorizon_s = 30\n[factors]\nagents = [\"{0}\"]\nlayouts = [\"aisle-grid\"]\n"
        "fleet_sizes = [3]\nloss = [0.0, 0.4]\ndelay_s = [1]\n[[gate]]\nagent = \"{0}\"\nlimit = {1}\n"
        "min_transports_per_agv_hour = 0\nmethod = \"{2}\"\n",
        agent, limit, method);
  }
  nlohmann::json report(const std::string& archive) {
    return nlohmann::json::parse(run("report " + archive + " --json").out);
  }
};

TEST_F(InCi, TheStepSummaryGetsThePageAndTheVerdictIsAnnotated) {
  ::setenv("GITHUB_STEP_SUMMARY", path("summary.md").c_str(), 1);
  ::setenv("GITHUB_ACTIONS", "true", 1);
  write("summary.md", "of an earlier step\n");
  const auto finished = run("run c.toml --db c.db --replicates 20");
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.err,
              HasSubstr("::error title=fleetproof violated::reckless broke the safety distance of 0.10 m"));
  EXPECT_THAT(read(path("summary.md")), testing::StartsWith("of an earlier step\n# fleetproof report: c"));
  EXPECT_LT(read(path("summary.md")).size(), 60'500U);
}

TEST_F(InCi, ExitZeroIsForThoseWhoReadTheReport) {
  EXPECT_EQ(run("run c.toml --db c.db --replicates 20 --exit-zero").exit_code, 0);
  EXPECT_EQ(run("report c.db").exit_code, 1);
  const auto junit = run("report c.db --format junit --exit-zero");
  EXPECT_EQ(junit.exit_code, 0);
  EXPECT_THAT(junit.out, HasSubstr("<failure type=\"violated\""));
}

TEST_F(InCi, UntilVerdictStopsAtTheFirstReplicateThatDecides) {
  write("good.toml", campaign("hull-lock", 0.1));
  const auto finished = run("run good.toml --db good.db --until-verdict -j 2");
  EXPECT_EQ(finished.exit_code, 0) << finished.out << finished.err;
  const auto json = report("good.db");
  EXPECT_EQ(json["campaign"]["complete_replicates"], 32) << "the first number that passes without a failure";
  EXPECT_EQ(json["campaign"]["stored_runs"], 64) << "and no run after it";
  EXPECT_EQ(json["complete"], false);
  ASSERT_EQ(run("run good.toml --db three.db --until-verdict -j 3").exit_code, 0);
  EXPECT_TRUE(read(path("good.db")) == read(path("three.db"))) << "with any number of workers";
  EXPECT_EQ(run("run good.toml --db good.db --until-verdict").exit_code, 0) << "there is nothing left to decide";
  EXPECT_EQ(report("good.db")["campaign"]["complete_replicates"], 32);
}

TEST_F(InCi, UntilVerdictStopsAtARefutation) {
  EXPECT_EQ(run("run c.toml --db c.db --until-verdict").exit_code, 1);
  EXPECT_LT(report("c.db")["campaign"]["complete_replicates"], 100);
}

TEST_F(InCi, UntilVerdictDoesNotStopAFixedGateEarly) {
  write("fixed.toml", campaign("hull-lock", 0.1, "fixed"));
  EXPECT_EQ(run("run fixed.toml --db fixed.db --until-verdict --replicates 60").exit_code, 0);
  EXPECT_EQ(report("fixed.db")["campaign"]["complete_replicates"], 60);
}

}  // namespace
}  // namespace fleetproof::ci_summary_test
