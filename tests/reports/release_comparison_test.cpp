#include "reports/comparison/release_comparison.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "core/base/random.hpp"
#include "reports/evidence/binomial.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::release_comparison_test {
namespace {

// Releases in two cells; `fails` says which runs break the safety distance.
ReleaseRuns release(const std::string& agent, std::uint64_t worlds,
                    const std::function<bool(std::uint64_t world, std::size_t cell)>& fails, std::uint64_t seed = 1) {
  ReleaseRuns runs{agent + ".db", agent, samples::campaign_of("claim", worlds), {}, {}, 0, 0, false};
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

const EndPointChange& of(const Comparison& comparison, EndPoint end_point) {
  return *std::ranges::find(comparison.end_points, end_point, &EndPointChange::end_point);
}

Change violation_change(const ReleaseRuns& old_release, const ReleaseRuns& new_release) {
  return of(compare(old_release, new_release, {}), EndPoint::Violation).change;
}

auto in_first(std::uint64_t count) {
  return [count](std::uint64_t world, std::size_t) { return world < count; };
}

TEST(Comparison, CountsWorldsThatDiffer) {
  const auto old_release = release("a", 20, in_first(3));
  const auto new_release =
      release("b", 20, [](std::uint64_t world, std::size_t cell) { return cell == 1 && world >= 2 && world < 18; });
  const Comparison found = compare(old_release, new_release, {});
  EXPECT_TRUE(found.same_worlds);
  const EndPointChange& violation = found.end_points[0];
  EXPECT_EQ(violation.before.failed, 3U);
  EXPECT_EQ(violation.now.failed, 16U);
  EXPECT_EQ(violation.only_old, 2U);
  EXPECT_EQ(violation.only_new, 15U);
  EXPECT_EQ(violation.change, Change::Worse) << "0.1^2 x 1.9^15 / 3 is above 20";
  EXPECT_EQ(found.newly_failing.size(), 15U) << "world 2 failed before in this cell, too";
  EXPECT_EQ(found.newly_failing.front(), 7U) << "world 3, second cell";
  EXPECT_EQ(found.newly_passing.size(), 2U * 3U - 1U);
  EXPECT_EQ(compare(new_release, old_release, {}).end_points[0].change, Change::Improved);
}

TEST(Comparison, NoDifferenceIsNoEvidenceWithoutEnoughWorlds) {
  const Comparison few = compare(release("a", 20, never), release("b", 20, never), {});
  EXPECT_EQ(few.end_points[0].change, Change::CannotTell);
  ASSERT_TRUE(few.end_points[0].worlds_needed.has_value());
  const std::uint64_t enough = *few.end_points[0].worlds_needed;
  EXPECT_EQ(enough, 81U) << "(1.0125^n + 1.025^n + 1.05^n) / 3 reaches 20";
  EXPECT_EQ(violation_change(release("a", enough, never), release("b", enough, never)), Change::NotWorse);
  EXPECT_EQ(violation_change(release("a", enough - 1, never), release("b", enough - 1, never)), Change::CannotTell);
}

TEST(Comparison, OtherSeedsTakeMoreWorlds) {
  const auto half = [](std::uint64_t world, std::size_t) { return world % 2 == 0; };
  const Comparison seeds = compare(release("a", 40, never, 1), release("b", 30, half, 2), {});
  EXPECT_FALSE(seeds.same_worlds);
  EXPECT_EQ(seeds.worlds, 30U);
  EXPECT_EQ(seeds.end_points[0].change, Change::Worse) << "0 against 15 of 30";
  EXPECT_TRUE(seeds.newly_failing.empty()) << "they are other worlds";
}

TEST(Comparison, UnderOtherConditionsNothingCanBeTold) {
  const auto planned = [](const std::string& text, std::uint64_t seed = 1) {
    auto runs = release("a", 200, never, seed);
    runs.campaign.plan_json = text;
    return runs;
  };
  const std::string plan =
      R"({"name": "a", "seed": 1, "horizon_s": 60, "gates": [1], "factors": {"agents": ["a"], "loss": [0]}})";
  const auto base = planned(plan);
  const auto same = planned(
      R"({"name": "b", "seed": 2, "horizon_s": 60, "keep": "failing", "factors": {"agents": ["b"], "loss": [0]}})", 2);
  EXPECT_EQ(violation_change(base, same), Change::NotWorse);
  for (const auto& [field, text] : std::initializer_list<std::pair<std::string, std::string>>{
           {"horizon_s", R"({"horizon_s": 90, "factors": {"agents": ["a"], "loss": [0]}})"},
           {"radio", R"({"horizon_s": 60, "radio": {"duplicates": 0.1}, "factors": {"agents": ["a"], "loss": [0]}})"},
           {"factors.loss.0", R"({"horizon_s": 60, "factors": {"agents": ["a"], "loss": [0.1]}})"},
           {"laws_left_out", R"({"horizon_s": 60, "laws_left_out": ["x"], "factors": {"loss": [0]}})"}}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const Comparison found = compare(base, planned(text, seed), {});
      EXPECT_EQ(found.other_conditions, std::vector{field});
      EXPECT_FALSE(found.any(Change::NotWorse)) << field;
    }
  }
  auto other = planned(plan);
  other.cells[1].lowest[Factor::Loss] = 0.3;
  EXPECT_EQ(compare(base, other, {}).other_conditions, std::vector<std::string>{"the cells"});
  auto newer = planned(plan);
  newer.campaign.engine.version = "9.9";
  EXPECT_EQ(compare(base, newer, {}).other_conditions, std::vector<std::string>{"the version of fleetproof"});
}

// Where less was asked of one release, what it did not fail in proves less.
TEST(Comparison, ALaxerReleaseLeavesADoubt) {
  auto base = release("a", 200, never);
  base.campaign.audit_share = 0.01;
  EXPECT_TRUE(compare(base, base, {}).doubts.empty());
  const auto laxer = [&](const std::function<void(ReleaseRuns&)>& change, const std::string& doubt) {
    auto other = base;
    change(other);
    for (const bool is_new : {true, false}) {
      const Comparison found = is_new ? compare(base, other, {}) : compare(other, base, {});
      EXPECT_EQ(found.doubts.size(), 1U);
      EXPECT_NE(found.doubts.at(0).find(doubt), std::string::npos) << found.doubts.at(0);
      EXPECT_NE(found.doubts.at(0).find(is_new ? "the new release" : "the old release"), std::string::npos);
      EXPECT_FALSE(found.any(Change::NotWorse)) << doubt;
    }
  };
  laxer([](ReleaseRuns& runs) { runs.campaign.required_probes = {"encounter"}; }, "did not have to meet negotiation?");
  laxer([](ReleaseRuns& runs) { runs.campaign.audit_share = 0.0; }, "were to be audited");
  laxer([](ReleaseRuns& runs) { runs.campaign.plan_json = R"({"default_gates": false})"; },
        "leaves the default gates out");
  laxer([](ReleaseRuns& runs) { runs.head = {{"weak", "few met", {}}}; }, "the evidence of the");
  auto failing = release("b", 200, in_first(100));
  failing.campaign.required_probes.clear();
  failing.campaign.audit_share = base.campaign.audit_share;
  EXPECT_EQ(violation_change(base, failing), Change::Worse) << "a doubt is no excuse";
}

ReleaseRuns unknown_in(ReleaseRuns runs, std::uint64_t worlds) {
  for (std::uint64_t world = 0; world < worlds; ++world) runs.replicates[world][0].results[0] = RunResult::Unknown;
  return runs;
}

// An old release that always crashes is no excuse for a new one.
TEST(Comparison, WhatStayedUnknownCountsAgainstWhatIsClaimed) {
  const auto crashing = unknown_in(release("a", 200, never), 200);
  EXPECT_EQ(violation_change(crashing, release("b", 200, in_first(200))), Change::CannotTell) << "it may have failed";
  EXPECT_NE(violation_change(crashing, release("b", 200, in_first(200))), Change::NotWorse) << "or not";
  EXPECT_EQ(violation_change(release("a", 200, never), unknown_in(release("b", 200, never), 200)), Change::CannotTell);
  EXPECT_EQ(violation_change(release("a", 200, in_first(200)), unknown_in(release("b", 200, never), 200)),
            Change::NotWorse)
      << "it cannot be worse than always";
  EXPECT_EQ(violation_change(crashing, release("b", 200, never)), Change::NotWorse);
  EXPECT_EQ(of(compare(crashing, release("b", 200, in_first(7)), {}), EndPoint::Violation).before.unknown, 200U);
}

TEST(Comparison, WorldsThatRepeatOthersProveNothing) {
  auto one = release("a", 200, never), other = release("b", 200, never);
  for (auto* runs : {&one, &other}) {
    for (std::uint64_t world = 1; world < 200; ++world) {
      for (ComparedRun& run : runs->replicates[world]) run.repeats = true;
    }
  }
  EXPECT_EQ(violation_change(one, other), Change::CannotTell);
  one.replicates.back()[0].repeats = false;
  EXPECT_EQ(violation_change(one, other), Change::CannotTell) << "two are distinct";
  EXPECT_EQ(violation_change(release("a", 200, never), other), Change::CannotTell)
      << "the new one always does the same";
  EXPECT_EQ(violation_change(one, release("b", 200, never)), Change::CannotTell) << "the old one always did the same";
}

TEST(Comparison, AuditsThatDifferLeaveADoubt) {
  for (const bool in_old : {true, false}) {
    auto one = release("a", 200, never), other = release("b", 200, never);
    (in_old ? one : other).audited = 30;
    (in_old ? one : other).differing = 1;
    EXPECT_EQ(violation_change(one, other), Change::CannotTell);
    EXPECT_EQ(compare(one, other, {}).doubts.size(), 1U);
  }
}

TEST(Comparison, ThroughputThatDropsIsWorse) {
  auto slow = release("b", 60, never), a_little = release("b", 60, never);
  for (std::uint64_t world = 0; world < 60; ++world) {
    for (ComparedRun& run : slow.replicates[world]) run.transports_done = 8;
    a_little.replicates[world][0].transports_done = 9;  // 19 of 20
  }
  const auto usual = release("a", 60, never);
  const auto change = [](const ReleaseRuns& one, const ReleaseRuns& other) {
    return of(compare(one, other, {.margin = 0.1, .confidence = 0.95}), EndPoint::Throughput).change;
  };
  EXPECT_EQ(change(usual, slow), Change::Worse);
  EXPECT_EQ(change(slow, usual), Change::Improved);
  EXPECT_EQ(change(usual, a_little), Change::NotWorse);
  auto crashed = usual;
  for (auto& replicate : crashed.replicates) replicate[0].transports_done = replicate[1].transports_done = 0;
  EXPECT_EQ(change(usual, crashed), Change::Worse);
}

TEST(Comparison, WithoutWorldsNothingIsSaid) {
  const Comparison none = compare(release("a", 0, never), release("b", 0, never), {});
  EXPECT_EQ(none.end_points[0].change, Change::CannotTell);
  EXPECT_FALSE(none.end_points[0].worlds_needed.has_value());
}

// 4 000 pairs of campaigns in which the new release is worse by just the margin.
TEST(Comparison, AWrongClaimIsAsRareAsPromised) {
  constexpr std::uint64_t kCampaigns = 4000, kWorlds = 120;
  const ComparisonRule rule{.margin = 0.1, .confidence = 0.95};
  std::uint64_t wrong = 0;
  Draws draws(2026);
  for (std::uint64_t i = 0; i < kCampaigns; ++i) {
    std::vector<int> values(kWorlds);
    for (int& value : values) {
      const double u = draws.uniform();
      value = u < 0.2 ? 1 : u < 0.3 ? -1 : 0;
    }
    const auto old_release =
        release("a", kWorlds, [&](std::uint64_t world, std::size_t cell) { return cell == 0 && values[world] < 0; });
    const auto new_release =
        release("b", kWorlds, [&](std::uint64_t world, std::size_t cell) { return cell == 1 && values[world] > 0; });
    wrong += of(compare(old_release, new_release, rule), EndPoint::Violation).change == Change::NotWorse ? 1 : 0;
  }
  EXPECT_LE(lower_bound(wrong, kCampaigns, Confidence(0.99)), 0.05) << wrong;
}

}  // namespace
}  // namespace fleetproof::release_comparison_test
