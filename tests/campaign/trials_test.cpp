#include "campaign/shrink/trials.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "campaign/shrink/all_runs.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof::trials_test {
namespace {

constexpr std::size_t kDraws = 40;

// Draws of one scenario of which some fail and some do not.
struct Draws {
  Draws() {
    WorldSpec spec;
    spec.fleet_size = 3;
    spec.horizon = std::chrono::seconds(30);
    spec.demand.transports_per_agv_hour = 120.0;
    RejectionCounts ignored;
    scenario = generate_world(spec, 3, ignored);
    scenario.radio.loss = 0.3;
    scenario.radio.delay_s = 1.0;
  }
  Candidates from(std::size_t first) const {
    return {kDraws - first, [this, first](std::size_t rank) {
              return std::optional(with_other_draws(scenario, static_cast<std::uint32_t>(first + rank)));
            }};
  }
  Scenario scenario;
};

TEST(Trials, TheFirstInOrderCountsForAnyNumberOfWorkers) {
  const Draws draws;
  AgentPrograms programs;
  CaseHost alone({"timeout-grant", ""}, programs, 1), crowd({"timeout-grant", ""}, programs, 7);
  const auto runs = all_runs(crowd, draws.from(0));
  std::optional<FailurePattern> pattern;
  std::size_t failing = 0;
  for (const auto& run : runs) {
    const auto failure = failure_of(*run);
    failing += failure ? 1 : 0;
    if (failure && !pattern) pattern = FailurePattern{failure->kind};
  }
  ASSERT_GT(failing, 1U);
  ASSERT_LT(failing, kDraws);
  for (std::size_t first = 0; first < kDraws; first += 3) {
    std::optional<std::size_t> expected;
    for (std::size_t i = first; i < kDraws && !expected; ++i) {
      if (pattern->match(alone(*draws.from(0).make(i)))) expected = i - first;
    }
    TrialCache cache;
    Trials trials(crowd, cache, *pattern, {});
    const auto found = trials.first_failing(draws.from(first));
    EXPECT_EQ(found ? std::optional(found->rank) : std::nullopt, expected) << first;
    EXPECT_EQ(trials.count(), expected ? *expected + 1 : kDraws - first);
  }
}

// Counts the verdicts: one for each candidate that was simulated.
struct CountingCache : TrialCache {
  void add(std::uint64_t digest, bool fails) override {
    ++added;
    TrialCache::add(digest, fails);
  }
  std::atomic<std::uint64_t> added = 0;
};

TEST(Trials, NoneIsMadeBeyondTheLimit) {
  const Draws draws;
  AgentPrograms programs;
  CaseHost host({"timeout-grant", ""}, programs, 2);
  CountingCache cache;
  Trials trials(host, cache, FailurePattern{{"never seen", {}}}, {7});
  EXPECT_FALSE(trials.first_failing(draws.from(0)));
  EXPECT_EQ(trials.count(), 7U);
  EXPECT_EQ(cache.added, 7U);
  EXPECT_TRUE(trials.ended());  // 33 were not tried
  EXPECT_FALSE(trials.first_failing(draws.from(10)));
  EXPECT_TRUE(trials.ended());
  EXPECT_EQ(cache.added, 7U);
}

// What an earlier search has found out is asked of nobody again.
TEST(Trials, KnownAnswersTakeNoWorkers) {
  using namespace std::chrono_literals;
  const Draws draws;
  AgentPrograms programs;
  const CaseHost any_time({"timeout-grant", ""}, programs, 2);
  const TimeLimit limit(TimeLimit::Clock::now() + 2s);
  CaseHost host = any_time.within(limit);
  const FailurePattern none{{"never seen", {}}};
  TrialCache cache;
  EXPECT_FALSE(Trials(host, cache, none, {}).first_failing(draws.from(1)));
  const std::uint64_t simulated = host.simulated();
  const auto caller = std::this_thread::get_id();
  const Candidates known{kDraws - 1, [&](std::size_t rank) {
                           EXPECT_EQ(std::this_thread::get_id(), caller);
                           return draws.from(1).make(rank);
                         }};
  Trials again(host, cache, none, {});
  EXPECT_FALSE(again.first_failing(known));
  EXPECT_EQ(again.count(), kDraws - 1);
  EXPECT_EQ(host.simulated(), simulated);
}

// The bound holds for all that a search does, and in the middle of a run, too.
TEST(Trials, NoneIsMadeWhenTheTimeIsOver) {
  const Draws draws;
  AgentPrograms programs;
  const CaseHost any_time({"timeout-grant", ""}, programs, 2);
  const TimeLimit limit(TimeLimit::Clock::now());
  while (!limit.is_over()) std::this_thread::yield();
  CaseHost host = any_time.within(limit);
  TrialCache cache;
  Trials trials(host, cache, FailurePattern{{"never seen", {}}}, {});
  EXPECT_FALSE(trials.first_failing(draws.from(0)));
  EXPECT_TRUE(trials.ended());
  EXPECT_EQ(host.simulated(), 0U);
  EXPECT_THROW(host(draws.scenario), GivenUp);
}

}  // namespace
}  // namespace fleetproof::trials_test
