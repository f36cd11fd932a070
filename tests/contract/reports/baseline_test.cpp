// `report --baseline`: what a page says about the campaign before.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/contract/reports/two_releases.hpp"

namespace fleetproof::baseline_test {
namespace {

using testing::HasSubstr;
using testing::Not;

using Baseline = test::TwoReleases;

constexpr const char* kTitle = "Compared with the baseline";

TEST_F(Baseline, SaysWhatVerbCompareSays) {
  const auto compared = nlohmann::json::parse(run("compare old.db new.db --json").out);
  const auto& violation = compared["end_points"][0];
  const std::string before = std::to_string(violation["old_failed"].get<int>()),
                    now = std::to_string(violation["new_failed"].get<int>());
  ASSERT_EQ(violation["change"], "worse");
  run("report new.db --baseline old.db --html page.html");
  for (const std::string& page : {read(path("page.html")), run("report new.db --baseline old.db").out,
                                  run("report new.db --baseline old.db --format markdown").out}) {
    EXPECT_THAT(page, HasSubstr(kTitle));
    EXPECT_THAT(page, HasSubstr("both ran in the same 12 worlds"));
    EXPECT_THAT(page, testing::ContainsRegex("violation[^0-9]+worse[^0-9]+" + before + "[^0-9]+" + now));
    EXPECT_THAT(page, HasSubstr(fmt::format("Newly failing: run {}", compared["newly_failing"][0].get<int>())));
    EXPECT_THAT(page, HasSubstr(fmt::format("fleetproof replay new.db {}", compared["newly_failing"][0].get<int>())));
  }
}

TEST_F(Baseline, OtherSeedsAreTold) {
  run_release("other", "reckless", 2);
  EXPECT_THAT(run("report other.db --baseline old.db").out, HasSubstr("drawn from other seeds"));
}

TEST_F(Baseline, WithoutItTheSectionIsAbsent) {
  EXPECT_THAT(run("report new.db").out, Not(HasSubstr(kTitle)));
  run("report new.db --html page.html");
  EXPECT_THAT(read(path("page.html")), Not(HasSubstr(kTitle)));
}

TEST_F(Baseline, IsNoChangeOfTheVerdict) {
  EXPECT_EQ(run("report new.db --baseline old.db").exit_code, run("report new.db").exit_code);
  EXPECT_EQ(run("report old.db --baseline new.db").exit_code, run("report old.db").exit_code);
}

TEST_F(Baseline, BadWordsAreRefused) {
  for (const char* words : {"report new.db --baseline none.db", "report new.db --baseline old.db --json",
                            "report new.db --baseline old.db --format junit", "report new.db --baseline new.toml"}) {
    const auto refused = run(words);
    EXPECT_EQ(refused.exit_code, 2) << words;
    EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
  }
}

}  // namespace
}  // namespace fleetproof::baseline_test
