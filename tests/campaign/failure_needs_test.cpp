#include "campaign/findings/failure_needs.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "campaign/findings/ingredients.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::failure_needs_test {
namespace {

using test::bad_night;
using testing::Contains;
using testing::Not;
using Bench = test::CaseBench;

TEST(FailureNeeds, SilenceTakenForConsentNeedsLostMessagesAndNoFault) {
  Bench bench("timeout-grant");
  std::size_t right = 0;
  for (std::uint64_t seed = 100; seed < 800; seed += 100) {
    const auto found = needs_of(bench.host, bench.failing(seed));
    ASSERT_TRUE(found);
    EXPECT_LE(found->replays, kReplaysPerFailure);
    EXPECT_EQ(found->end, "too close, two AGVs");
    right += std::ranges::count(found->needs, std::string(kLostMessages)) == 1 &&
             std::ranges::count(found->needs, std::string("restart")) == 0;
    const auto again = failure_of(bench.host(found->reduced.scenario));
    ASSERT_TRUE(again);
    EXPECT_EQ(again->at, found->reduced.failure.at);
  }
  EXPECT_GE(right, 6U) << "of 7";
}

TEST(FailureNeeds, AForgottenLaneNeedsARestart) {
  Bench bench("restart-forgets-lane");
  const auto found = needs_of(bench.host, bench.failing(1));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->needs, Contains("restart"));
  EXPECT_THAT(found->needs, Not(Contains(kCopiedMessages)));
}

// Of a failure that hardly any other draw meets, a need is believed only after all replays that are allowed.
TEST(FailureNeeds, WhatARareFailureSeemsToNeedIsTriedAgain) {
  Bench bench("timeout-grant");
  std::size_t rare = 0;
  for (std::uint64_t seed = 1; seed < 400 && rare < 3; ++seed) {
    Scenario scenario = bad_night(seed);
    scenario.radio.loss = 0.15;
    const auto found = needs_of(bench.host, scenario);
    if (!found || found->failing_draws > 4 || found->needs.empty()) continue;
    ++rare;
    EXPECT_GE(found->replays, kReplaysPerFailure - 3);
    EXPECT_LE(found->replays, kReplaysPerFailure);
  }
  EXPECT_GT(rare, 0U);
}

// With hundreds of kinds, no replay is left for the second round.
TEST(FailureNeeds, AnAgentMayGiveEachMessageAKindOfItsOwn) {
  AgentPrograms programs;
  const std::string name = programs.know(FLEETPROOF_RETOUCHED_AGENT);
  CaseHost host({name, "timeout-grant numbered"}, programs, 2);
  std::size_t rare = 0;
  for (std::uint64_t seed = 1; seed < 400 && rare < 2; ++seed) {
    Scenario scenario = bad_night(seed);
    scenario.radio.loss = 0.15;
    const auto found = needs_of(host, scenario);
    if (!found || found->failing_draws > 4) continue;
    ++rare;
    EXPECT_LE(found->replays, kReplaysPerFailure);
    EXPECT_LE(found->needs.size(), 16 + ingredients_of(scenario, {}).size());
  }
  EXPECT_GT(rare, 0U);
}

TEST(FailureNeeds, OfARunWithoutAFailureThereAreNone) {
  Bench bench("hull-lock");
  EXPECT_FALSE(needs_of(bench.host, bad_night(1)));
}

}  // namespace
}  // namespace fleetproof::failure_needs_test
