// Two releases of the same software, through the program.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/contract/reports/two_releases.hpp"

namespace fleetproof::compare_test {
namespace {

using testing::HasSubstr;

using Compare = test::TwoReleases;

TEST_F(Compare, TellsARegressionWithItsRuns) {
  const auto told = run("compare old.db new.db --fail-on-regression");
  EXPECT_EQ(told.exit_code, 1) << told.err;
  EXPECT_THAT(told.out, HasSubstr("both ran in the same 12 worlds"));
  EXPECT_THAT(told.out, HasSubstr("violation   worse: 0 -> "));
  EXPECT_THAT(told.out, HasSubstr("  -> fleetproof replay new.db "));
  EXPECT_EQ(run("compare old.db new.db").exit_code, 0) << "without the flag it tells and no more";
  const auto back = nlohmann::json::parse(run("compare new.db old.db --json").out);
  EXPECT_EQ(back["end_points"][0]["change"], "improved");
  EXPECT_EQ(back["newly_failing"].size(), 0U);
  EXPECT_GT(back["newly_passing"].size(), 0U);
}

TEST_F(Compare, TheSameReleaseCannotBeToldApartWithFewWorlds) {
  const auto same = run("compare old.db old.db --fail-on-regression");
  EXPECT_EQ(same.exit_code, 4);
  EXPECT_THAT(same.out, HasSubstr("violation   cannot tell: 0 -> 0"));
  EXPECT_THAT(same.out, HasSubstr("newly failing: none"));
  EXPECT_EQ(run("compare old.db old.db --margin 0.9 --fail-on-regression").exit_code, 0);
}

TEST_F(Compare, OtherSeedsTakeMoreWorlds) {
  run_release("other", "reckless", 2);
  const auto told = run("compare old.db other.db --fail-on-regression");
  EXPECT_EQ(told.exit_code, 1);
  EXPECT_THAT(told.out, HasSubstr("12 worlds of each, drawn from other seeds"));
}

TEST_F(Compare, BadWordsAreRefused) {
  EXPECT_EQ(run("compare old.db").exit_code, 2);
  EXPECT_EQ(run("compare old.db none.db").exit_code, 2);
  EXPECT_EQ(run("compare old.db new.db --margin 0").exit_code, 2);
  EXPECT_EQ(run("compare old.db new.db --confidence 95").exit_code, 2);
  EXPECT_THAT(run("compare old.db new.db --agent candidat").err, HasSubstr("did you mean \"candidate\"?"));
}

}  // namespace
}  // namespace fleetproof::compare_test
