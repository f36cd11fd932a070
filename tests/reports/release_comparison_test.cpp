#include "reports/comparison/release_comparison.hpp"

#include <gtest/gtest.h>

#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::release_comparison_test {
namespace {

// Releases in two cells; `fails` says which runs break the safety distance.
ReleaseRuns release(const std::string& agent, std::uint64_t worlds,
                    const std::function<bool(std::uint64_t world, std::size_t cell)>& fails, std::uint64_t seed = 1) {
  ReleaseRuns runs{agent + ".db", agent, samples::campaign_of("claim", worlds), {}, {}};
  runs.campaign.seed = seed;
  runs.cells = samples::grid({agent}, {0.0, 0.4}, {2.0});
  for (std::uint64_t world = 0; world < worlds; ++world) {
    auto& replicate = runs.replicates.emplace_back();
    for (std::size_t cell = 0; cell < 2; ++cell) {
      ComparedRun& run = replicate.emplace_back();
      run.run_index = 2 * world + cell;
      if (fails(world, cell)) run.results[0] = RunResult::Failed;  // Violation
      run.transports_done = 10;
      run.agv_us = 3'600'000'000;
    }
  }
  return runs;
}

bool never(std::uint64_t, std::size_t) { return false; }

TEST(Comparison, CountsWorldsThatDiffer) {
  const auto old_release = release("a", 20, [](std::uint64_t world, std::size_t) { return world < 3; });
  const auto new_release =
      release("b", 20, [](std::uint64_t world, std::size_t cell) { return cell == 1 && world >= 2 && world < 14; });
  const Comparison found = compare(old_release, new_release, {});
  ASSERT_TRUE(found.paired) << found.why_unpaired;
  const EndPointChange& violation = found.end_points[0];
  EXPECT_EQ(violation.old_failing, 3U);
  EXPECT_EQ(violation.new_failing, 12U);
  EXPECT_EQ(violation.pairs->both, 1U);
  EXPECT_EQ(violation.pairs->only_old, 2U);
  EXPECT_EQ(violation.pairs->only_new, 11U);
  // P(X >= 11), X binomial of 13 and 1/2: (78 + 13 + 1) / 8192.
  EXPECT_NEAR(violation.worse_p, 92.0 / 8192.0, 1e-15);
  EXPECT_EQ(violation.change, Change::Worse);
  EXPECT_EQ(found.newly_failing.size(), 11U) << "world 2 failed before in this cell, too";
  EXPECT_EQ(found.newly_failing.front(), 7U) << "world 3, second cell";
  EXPECT_EQ(found.newly_passing.size(), 2U * 3U - 1U);
  EXPECT_EQ(compare(new_release, old_release, {}).end_points[0].change, Change::Improved);
}

TEST(Comparison, NoDifferenceIsNoEvidenceWithoutEnoughWorlds) {
  const Comparison few = compare(release("a", 20, never), release("b", 20, never), {});
  EXPECT_EQ(few.end_points[0].change, Change::CannotTell);
  ASSERT_TRUE(few.end_points[0].worlds_needed.has_value());
  const std::uint64_t enough = *few.end_points[0].worlds_needed;
  EXPECT_GT(enough, 20U);
  EXPECT_EQ(compare(release("a", enough, never), release("b", enough, never), {}).end_points[0].change,
            Change::NotWorse);
  EXPECT_EQ(compare(release("a", enough - 20, never), release("b", enough - 20, never), {}).end_points[0].change,
            Change::CannotTell);
}

TEST(Comparison, OtherSeedsOrScenariosAreNotPaired) {
  const auto fails_often = [](std::uint64_t world, std::size_t) { return world % 2 == 0; };
  const Comparison seeds = compare(release("a", 40, never, 1), release("b", 30, fails_often, 2), {});
  EXPECT_FALSE(seeds.paired);
  EXPECT_EQ(seeds.why_unpaired, "the seeds differ");
  EXPECT_FALSE(seeds.end_points[0].pairs.has_value());
  EXPECT_EQ(seeds.end_points[0].old_worlds, 40U);
  EXPECT_EQ(seeds.end_points[0].new_worlds, 30U);
  EXPECT_EQ(seeds.end_points[0].change, Change::Worse) << "0 of 40 against 15 of 30";
  auto other = release("b", 40, never);
  other.cells[1].lowest[Factor::Loss] = 0.3;
  EXPECT_EQ(compare(release("a", 40, never), other, {}).why_unpaired, "the cells differ");
}

TEST(Comparison, ReleasesMayHaveOtherNamesAgentsAndGatesButNoOtherWorlds) {
  const auto planned = [](const std::string& text) {
    auto runs = release("a", 2, never);
    runs.campaign.plan_json = text;
    return runs;
  };
  const auto base =
      planned(R"({"name": "a", "horizon_s": 60, "gates": [1], "factors": {"agents": ["a"], "loss": [0]}})");
  const auto same =
      planned(R"({"name": "b", "horizon_s": 60, "gates": [], "factors": {"agents": ["b"], "loss": [0]}})");
  const auto longer = planned(R"({"name": "a", "horizon_s": 90, "factors": {"agents": ["a"], "loss": [0]}})");
  EXPECT_TRUE(compare(base, same, {}).paired);
  EXPECT_EQ(compare(base, longer, {}).why_unpaired, "the plans differ in /horizon_s");
}

TEST(Comparison, WhatStayedUnknownCountsAsFailing) {
  auto crashing = release("b", 20, never);
  for (std::uint64_t world = 0; world < 8; ++world) crashing.replicates[world][0].results[0] = RunResult::Unknown;
  EXPECT_EQ(compare(release("a", 20, never), crashing, {}).end_points[0].change, Change::Worse);
}

TEST(Comparison, WithoutWorldsNothingIsSaid) {
  const Comparison none = compare(release("a", 0, never), release("b", 0, never), {});
  EXPECT_EQ(none.end_points[0].change, Change::CannotTell);
  EXPECT_FALSE(none.end_points[0].worlds_needed.has_value());
}

}  // namespace
}  // namespace fleetproof::release_comparison_test
