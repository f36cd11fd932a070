// A saved case is judged by the laws of its campaign, whichever verb plays it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/program.hpp"

namespace fleetproof::left_out_laws_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class LeftOutLaws : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("c.toml",
          "name = \"c\"\nkind = \"search\"\nreplicates = 1\nhorizon_s = 600\n[law]\nleave_out = [\"progress\"]\n"
          "[factors]\nagents = [\"asks-once\"]\nlayouts = [\"aisle-grid\"]\nloss = [0.4]\ndelay_s = [2]\n");
    ASSERT_TRUE(test::has_verdict(run("run c.toml --db c.db")));
  }
  // What the law "progress" would add to that.
  testing::Matcher<std::string> is_judged_alike() const {
    return AllOf(HasSubstr("standstill-in-contract: "), Not(HasSubstr("deadlock: ")));
  }
};

TEST_F(LeftOutLaws, StandInTheScenarioOfARun) {
  EXPECT_THAT(run("replay c.db 0 --scenario s.json").out, is_judged_alike());
  EXPECT_THAT(run("simulate s.json").out, is_judged_alike());
  ASSERT_EQ(shell("sed -i 's/, \"leave_out\": \\[\"progress\"\\]//' s.json").exit_code, 0);
  EXPECT_THAT(run("simulate s.json").out, HasSubstr("deadlock: ")) << "the run shows no difference";
}

TEST_F(LeftOutLaws, StandInShrunkCases) {
  ASSERT_EQ(run("shrink c.db 0 -o small.json --max-trials 60").exit_code, 0);
  const auto known = run("simulate small.json");
  EXPECT_THAT(known.out, AllOf(is_judged_alike(), HasSubstr("as expected")));
  const auto again = run("shrink small.json -o smaller.json --max-trials 60");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(run("simulate smaller.json").out, AllOf(is_judged_alike(), HasSubstr("as expected")));
}

TEST_F(LeftOutLaws, AreRefusedIfNoCampaignCouldLeaveThemOut) {
  ASSERT_EQ(run("replay c.db 0 --scenario s.json").exit_code, 0);
  const auto error_with = [&](const std::string& name) {
    EXPECT_EQ(shell("sed 's/\"leave_out\": .*\\]/\"leave_out\": [" + name + "]/' s.json > t.json").exit_code, 0);
    for (const char* verb : {"simulate", "check", "shrink", "explain"}) {
      const auto refused = run(std::string(verb) + " t.json");
      EXPECT_EQ(refused.exit_code, 2) << verb;
      EXPECT_THAT(refused.err, HasSubstr("/law/leave_out/0: ")) << verb;
    }
    return run("simulate t.json").err;
  };
  EXPECT_THAT(error_with("\"progres\""), HasSubstr("did you mean \"progress\"?"));
  EXPECT_THAT(error_with("\"safety-distance\""), HasSubstr("the judge of violations"));
  EXPECT_THAT(error_with("4"), HasSubstr("4 is refused: expected a text"));
}

}  // namespace
}  // namespace fleetproof::left_out_laws_test
