#include "campaign/findings/word_comparison.hpp"

#include <gtest/gtest.h>

#include "campaign/findings/failure_needs.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::word_comparison_test {
namespace {

constexpr AgvId kOne{1U}, kOther{2U}, kBystander{3U};

Failure failure_at(SimTime at) {
  Failure failure;
  failure.at = at;
  failure.a = kOne;
  failure.b = kOther;
  return failure;
}

CaseRun run_that_says(std::vector<Declared> said) {
  CaseRun run;
  run.first_said = std::move(said);
  return run;
}

TEST(WordComparison, TheChanceIsThatOfAnyOrderOfTheRuns) {
  EXPECT_DOUBLE_EQ(chance_that_all_say(1, 0, 9), 0.1);        // the one that says it of ten is the one that fails
  EXPECT_DOUBLE_EQ(chance_that_all_say(2, 1, 2), 3.0 / 6.0);  // three of four say it, among them both that fail
  EXPECT_DOUBLE_EQ(chance_that_all_say(3, 5, 5), 1.0);
}

TEST(WordComparison, AWordThatIsAsCommonWithoutAFailureTellsNothing) {
  const Failure failure = failure_at(kStart + seconds(10.0));
  const CaseRun quiet = run_that_says({}), saying = run_that_says({{kOther, "late", kStart + seconds(9.0)}});
  WordComparison comparison(failure);
  for (int i = 0; i < 3; ++i) comparison.add_failing();
  for (int i = 0; i < 6; ++i) comparison.add_passing(quiet);
  for (int i = 0; i < 4; ++i) comparison.add_passing(saying);
  EXPECT_TRUE(comparison.is_telling("late"));  // 5 6 7 8 / 11 12 13 14 = 0.07
  for (int i = 0; i < 2; ++i) comparison.add_passing(saying);
  EXPECT_FALSE(comparison.is_telling("late"));  // 7 8 9 10 / 13 14 15 16 = 0.12
}

TEST(WordComparison, WhatBystandersSayOrWhatIsSaidLaterDoesNotCount) {
  const Failure failure = failure_at(kStart + seconds(10.0));
  const CaseRun bystander = run_that_says({{kBystander, "late", kStart + seconds(1.0)}}),
                later = run_that_says({{kOne, "late", kStart + seconds(15.5)}}),
                in_time = run_that_says({{kOne, "late", kStart + seconds(14.5)}});
  WordComparison comparison(failure);
  for (int i = 0; i < 5; ++i) {
    comparison.add_passing(bystander);
    comparison.add_passing(later);
  }
  EXPECT_TRUE(comparison.is_telling("late"));
  comparison.add_passing(in_time);
  EXPECT_FALSE(comparison.is_telling("late"));
}

// AGVs of hull-lock say "grant-lost" where messages are late. A failure that needs no late messages must not need them
// for that word.
TEST(WordComparison, AWordOfTheRadioIsNoPartOfAFailureThatNeedsARestart) {
  test::CaseBench bench("restart-forgets-lane");
  std::uint64_t seed = 1;
  for (int i = 0; i < 6; ++i, ++seed) {
    const Scenario scenario = bench.failing(seed);
    const auto found = needs_of(bench.host, scenario);
    ASSERT_TRUE(found);
    EXPECT_EQ(std::ranges::count(found->traits, trait_of_word("grant-lost")), 0) << seed;
  }
}

}  // namespace
}  // namespace fleetproof::word_comparison_test
