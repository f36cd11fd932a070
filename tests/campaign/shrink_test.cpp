#include "campaign/shrink/shrink.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/scenario_source.hpp"
#include "campaign/shrink/adverse_deliveries.hpp"
#include "campaign/shrink/other_draws.hpp"
#include "campaign/shrink/surgery.hpp"
#include "campaign/shrink/trial_file.hpp"
#include "core/engine/simulation.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "generators/scenario_file/scenario_text.hpp"
#include "tests/support/case_bench.hpp"

namespace fleetproof::shrink_test {
namespace {

using test::bad_radio;

const OnSmaller kNobody = [](const FailingCase&, std::string_view) {};

struct Bench : test::CaseBench {
  using CaseBench::CaseBench;

  ShrinkResult shrunk(const FailingCase& failing, const TrialLimits& limits = {}, TrialCache* cache = nullptr) {
    TrialCache own;
    return shrink(host, cache != nullptr ? *cache : own, failing, pattern_of(host, failing), limits, kNobody);
  }
};

// On a perfect radio, it may take a larger fleet to fail. Two AGVs and a lost message are easier to see through.
TEST(Shrink, AFewMessagesArePreferredToALargeFleet) {
  const auto price = [](std::size_t agvs, std::size_t deliveries) {
    CaseSize size;
    size.agvs = agvs;
    size.deliveries = deliveries;
    size.deliveries_are_drawn = false;
    return size.price();
  };
  EXPECT_LT(price(2, 1), price(4, 0));
  EXPECT_LT(price(3, 3), price(4, 0));
  EXPECT_LT(price(4, 0), price(3, 8));
  EXPECT_LT(price(3, 0), price(2, 1));
  EXPECT_LT(price(5, 99), CaseSize{}.price()) << "the radio still draws";
}

// With the radio made perfect first, this one needs all five AGVs; with the fleet made small first, three.
TEST(Shrink, AFleetThatStaysLargeIsMadeSmallBeforeTheRadioIsMadePerfect) {
  const CampaignPlan plan = parse_campaign_file(R"(
name = "night"
seed = 921
replicates = 40
horizon_s = 60
[factors]
agents = ["stale-grant"]
layouts = ["aisle-grid/stress", "fishbone/stress", "plant/crossing", "plant/curve-beside-lane"]
fleet_sizes = [5]
loss = [0.4]
delay_s = [2]
[world]
transports_per_agv_hour = 240
placement = "mixed"
[vehicle]
speed_mps = 3
acceleration_mps2 = 2
deceleration_mps2 = 2
turn_speed_radps = 2
turn_acceleration_radps2 = 2
turn_deceleration_radps2 = 2
pick_s = 2
drop_s = 2
loaded_extra_length_m = 0.6
loaded_extra_width_m = 0.3
[faults]
breakdowns_per_agv_hour = 30
repair_s = 15
restarts_per_agv_hour = 120
restart_s = 0.5
[radio]
delay_model = "uniform"
duplicates = 0.1
)",
                                                "night.toml")
                                .plan;
  Bench bench("stale-grant");
  const Scenario scenario = ScenarioSource(plan).scenario(47);
  const auto failure = failure_of(bench.host(scenario));
  ASSERT_TRUE(failure.has_value());
  const ShrinkResult result = bench.shrunk({scenario, *failure}, {.trials = 60000});
  EXPECT_LE(result.best.scenario.agvs.size(), 3U);
}

TEST(Shrink, ASmallCaseFailsInTheSameWay) {
  Bench bench("timeout-grant");
  for (const std::uint64_t seed : {1U, 20U, 40U}) {
    const FailingCase failing = bench.failing_by_radio(seed);
    const ShrinkResult result = bench.shrunk(failing);
    const CaseRun again = bench.host(result.best.scenario);
    const auto failure = failure_of(again);
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->kind.what, failing.failure.kind.what);
    EXPECT_EQ(failure->at, result.best.failure.at);
    // its own word for what it does wrong
    EXPECT_TRUE(std::ranges::binary_search(again.words, "silence-taken-for-consent"));
    EXPECT_LE(result.after.agvs, 3U);
    EXPECT_FALSE(result.after.deliveries_are_drawn);
    EXPECT_LE(result.after.deliveries, 8U);
    EXPECT_LE(result.after.horizon, result.best.failure.seen - kStart + std::chrono::seconds(1));
  }
}

// What is left is looked at once more, by other code: without any one thing, the run does not fail in this way.
TEST(Shrink, NothingOfItCanBeLeftOutAlone) {
  Bench bench("timeout-grant");
  const FailingCase failing = bench.failing_by_radio(1);
  const ShrinkResult result = bench.shrunk(failing);
  ASSERT_TRUE(result.one_minimal) << result.why_not;
  const FailurePattern pattern = pattern_of(bench.host, failing);
  const Scenario& least = result.best.scenario;
  const auto still_fails = [&](const Scenario& less) { return pattern.match(bench.host(less)).has_value(); };
  ASSERT_TRUE(still_fails(least));
  for (std::size_t i = 0; i < least.deliveries.size(); ++i) {
    Scenario less = least;
    less.deliveries.erase(less.deliveries.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_FALSE(still_fails(less)) << "message " << i;
  }
  for (std::size_t agv = 0; agv < least.agvs.size(); ++agv) {
    for (std::size_t i = 0; i < least.agvs[agv].transports.size(); ++i) {
      Scenario less = least;
      auto& orders = less.agvs[agv].transports;
      orders.erase(orders.begin() + static_cast<std::ptrdiff_t>(i));
      EXPECT_FALSE(still_fails(less)) << "transport " << i << " of AGV " << agv;
    }
  }
  ASSERT_FALSE(least.deliveries.empty());
}

TEST(Shrink, GivesTheSameCaseForAnyNumberOfWorkers) {
  std::vector<std::string> texts;
  for (const int workers : {1, 2, 7}) {
    Bench bench("timeout-grant", workers);
    texts.push_back(to_text(bench.shrunk(bench.failing_by_radio(3), {3000}).best.scenario));
  }
  EXPECT_EQ(texts[0], texts[1]);
  EXPECT_EQ(texts[0], texts[2]);
}

class ShrinkFile : public testing::Test {
 protected:
  ShrinkFile() { std::filesystem::create_directories(folder_); }
  ~ShrinkFile() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      (std::string("fleetproof-") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(ShrinkFile, GoesOnWhereItEnded) {
  Bench bench("timeout-grant");
  const FailingCase failing = bench.failing_by_radio(3);
  const std::string whole = to_text(bench.shrunk(failing, {3000}).best.scenario);
  const std::string path = folder_ / "case.json.trials";
  for (const std::uint64_t trials : {50U, 400U, 3000U}) {
    TrialFile file(path, "of this case");
    const ShrinkResult result = bench.shrunk(failing, {trials}, &file);
    if (trials == 3000) {
      EXPECT_EQ(to_text(result.best.scenario), whole);
    } else {
      EXPECT_FALSE(result.one_minimal);
      EXPECT_FALSE(result.why_not.empty());
    }
    std::ofstream(path, std::ios::app) << "0123";  // the program was killed while it wrote
  }
}

TEST_F(ShrinkFile, VerdictsOnAnotherCaseAreDropped) {
  const std::string path = folder_ / "case.json.trials";
  TrialFile(path, "one").add(7, false);
  EXPECT_EQ(TrialFile(path, "one").find(7), std::optional(false));
  EXPECT_EQ(TrialFile(path, "two").find(7), std::nullopt);
  std::ofstream(path) << "a letter\n";
  EXPECT_THROW(TrialFile(path, "one"), InputError);
}

TEST(Shrink, EndsInTime) {
  Bench bench("timeout-grant");
  const FailingCase failing = bench.failing_by_radio(1);
  const FailurePattern pattern = pattern_of(bench.host, failing);
  const TimeLimit limit(TimeLimit::Clock::now());
  while (!limit.is_over()) std::this_thread::yield();
  CaseHost host = bench.host.within(limit);
  TrialCache cache;
  const ShrinkResult result = shrink(host, cache, failing, pattern, {}, kNobody);
  EXPECT_TRUE(result.ended);
  EXPECT_FALSE(result.one_minimal);
  EXPECT_EQ(result.trials, 0U);
  EXPECT_EQ(scenario_digest(result.best.scenario), scenario_digest(failing.scenario));
}

// A longer run may fail on other timelines, so one is tried first.
TEST(Shrink, ASearchThatIsBrokenOffDoesNotMakeTheRunLonger) {
  Bench bench("timeout-grant");
  FailingCase failing = bench.failing_by_radio(1);
  failing.scenario.horizon = failing.failure.seen - kStart + std::chrono::seconds(1);
  const auto failure = failure_of(bench.host(failing.scenario));
  ASSERT_TRUE(failure);
  failing.failure = *failure;
  const ShrinkResult result = bench.shrunk(failing, {1});
  EXPECT_TRUE(result.ended);
  EXPECT_EQ(result.after.horizon, result.before.horizon);
}

// ---- what it rests on

// The run is the same when its deliveries are written down instead of drawn.
// Two AGVs that make the same mistake at once are rarer than one that makes it.
TEST(FailurePatterns, AskForAStateOfBothAgvsOnce) {
  test::CaseBench bench("counts-messages");
  const Scenario scenario = test::bad_night(2);
  const CaseRun run = bench.host(scenario);
  const auto failure = failure_of(run);
  ASSERT_TRUE(failure);
  ASSERT_EQ(failure->kind.states, (std::vector<std::string>{"driving", "driving"}));
  const FailurePattern pattern = pattern_of(bench.host, {scenario, *failure});
  ASSERT_EQ(pattern.states, std::vector<std::string>{"driving"});
  CaseRun one = run, none = run;
  one.states = {"driving", "waiting"};
  none.states = {"waiting", "waiting"};
  EXPECT_TRUE(pattern.match(run));
  EXPECT_TRUE(pattern.match(one));
  EXPECT_FALSE(pattern.match(none));
}

TEST(WrittenDeliveries, GiveTheSameRun) {
  Bench bench("hull-lock");
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Scenario scenario = bad_radio(seed);
    scenario.radio.duplicates = 0.1;
    const CaseRun drawn = bench.host(scenario, Deliveries::Kept);
    std::vector<GivenDelivery> deliveries;
    for (const MessageDelivery& message : adverse_of(drawn.deliveries)) deliveries.push_back(message.delivery);
    EXPECT_GT(deliveries.size(), 100U);
    const CaseRun written = bench.host(with_deliveries_only(scenario, deliveries));
    EXPECT_EQ(written.outcome.digest, drawn.outcome.digest);
    deliveries.pop_back();
    deliveries.erase(deliveries.begin());
    EXPECT_NE(bench.host(with_deliveries_only(scenario, deliveries)).outcome.digest, drawn.outcome.digest);
  }
}

// Where agents do not hear each other, an AGV does the same with and without the others.
TEST(DrawNumbers, AnAgvKeepsItsDrawsWithoutTheOthers) {
  Bench bench("reckless");
  Scenario scenario = bad_radio(5, 4);
  scenario.contact_stops = false;
  scenario.vehicle_types[0].speed_deviation = 0.1;
  scenario.vehicle_types[0].settle_s = 1.0;
  const auto alone = [&](std::size_t agv) { return with_agvs(scenario, [agv](std::size_t i) { return i == agv; }); };
  std::uint64_t sum_um = 0;
  for (std::size_t agv = 0; agv < 4; ++agv) sum_um += bench.host(alone(agv)).outcome.counters.distance_um;
  EXPECT_EQ(sum_um, bench.host(scenario).outcome.counters.distance_um);
  Scenario renumbered = alone(2);
  renumbered.agvs[0].draws_as.reset();
  EXPECT_NE(bench.host(renumbered).outcome.digest, bench.host(alone(2)).outcome.digest);
}

TEST(AdverseScope, NothingOfASparedKindIsLostOrLate) {
  Bench bench("hull-lock");
  Scenario scenario = bad_radio(4);
  scenario.radio.adverse.spared_kinds = {"GRANT", "REQUEST"};
  std::map<std::string, std::size_t> adverse, all;
  const CaseRun run = bench.host(scenario, Deliveries::Kept);
  for (const MessageDelivery& message : run.deliveries) {
    ++all[message.kind];
    adverse[message.kind] += message.is_adverse() ? 1 : 0;
  }
  EXPECT_EQ(adverse["GRANT"] + adverse["REQUEST"], 0U);
  EXPECT_GT(all["GRANT"], 5U);
  EXPECT_GT(all["REQUEST"], 5U);
  EXPECT_GT(adverse["STATE"], 20U);
  const auto& agent = AgentPrograms().find("hull-lock", "agent");
  EXPECT_EQ(simulate(scenario, agent, {}, nullptr).digest, run.outcome.digest) << "nobody traces, and it is the same";
}

TEST(AdverseScope, NothingIsLostOrLateOutsideItsTime) {
  Bench bench("hull-lock");
  Scenario scenario = bad_radio(4);
  scenario.radio.adverse.adverse_from_s = 20.0;
  scenario.radio.adverse.adverse_until_s = 25.0;
  std::size_t inside = 0;
  for (const MessageDelivery& message : bench.host(scenario, Deliveries::Kept).deliveries) {
    const bool is_inside = message.delivery.sent >= seconds(20.0) && message.delivery.sent < seconds(25.0);
    inside += is_inside ? 1 : 0;
    EXPECT_TRUE(is_inside || !message.is_adverse());
  }
  EXPECT_GT(inside, 20U);
}

TEST(Surgery, WhatReferredToAnAgvGoesWithIt) {
  Scenario scenario = bad_radio(1);
  for (std::uint32_t agv = 0; agv < 5; ++agv) scenario.faults.push_back({.agv = AgvId{agv}, .transport = 0U});
  scenario.deliveries = {{AgvId{0U}, AgvId{1U}, {}, 0, true}, {AgvId{3U}, AgvId{4U}, {}, 0, true}};
  const Scenario less = with_agvs(scenario, [](std::size_t agv) { return agv >= 3; });
  ASSERT_EQ(less.agvs.size(), 2U);
  EXPECT_EQ(less.agvs[0].name, scenario.agvs[3].name);
  EXPECT_EQ(less.agvs[0].draws_as, 3U);
  ASSERT_EQ(less.faults.size(), 2U);
  EXPECT_EQ(less.faults[1].agv, AgvId{1U});
  ASSERT_EQ(less.deliveries.size(), 1U);
  EXPECT_EQ(less.deliveries[0].sender, AgvId{0U});
  EXPECT_EQ(less.deliveries[0].receiver, AgvId{1U});
  const Scenario one = with_agvs(less, [](std::size_t agv) { return agv == 1; });
  EXPECT_EQ(one.agvs[0].draws_as, 4U);
}

TEST(Surgery, AFleetThatIsNumberedOtherwiseKeepsWhatItHad) {
  Scenario scenario = test::bad_night(125);
  scenario.deliveries.push_back(
      {.sender = AgvId{0U}, .receiver = AgvId{3U}, .sent = std::chrono::seconds(1), .lost = true});
  const Scenario other = with_fleet_renumbered(scenario, 2);
  EXPECT_EQ(other.agvs[0].start, scenario.agvs[2].start);
  EXPECT_EQ(other.agvs[3].start, scenario.agvs[0].start);
  EXPECT_EQ(other.agvs[3].draws_as, 0U);
  EXPECT_EQ(other.faults[0].agv.index(), 3U);
  EXPECT_EQ(other.deliveries.back().sender.index(), 3U);
  EXPECT_EQ(other.deliveries.back().receiver.index(), 1U);
  EXPECT_EQ(scenario_digest(with_fleet_renumbered(other, 3)),
            scenario_digest(with_agvs(scenario, [](std::size_t) { return true; })));
}

TEST(Surgery, FaultsFollowTheirTransport) {
  Scenario scenario = bad_radio(1);
  ASSERT_GE(scenario.agvs[1].transports.size(), 1U);
  scenario.agvs[1].transports.resize(3, scenario.agvs[1].transports[0]);
  for (std::uint32_t number = 0; number < 3; ++number)
    scenario.faults.push_back({.agv = AgvId{1U}, .transport = number});
  const std::size_t before = scenario.agvs[0].transports.size();
  const Scenario less = with_transports(scenario, [&](std::size_t i) { return i != before + 1; });
  EXPECT_EQ(less.agvs[1].transports.size(), 2U);
  ASSERT_EQ(less.faults.size(), 2U);
  EXPECT_EQ(less.faults[0].transport, 0U);
  EXPECT_EQ(less.faults[1].transport, 1U);
}

TEST(Surgery, StationsKeepTheirNamesWhenOthersGo) {
  const Scenario scenario = bad_radio(1);
  const auto name_at = [](const Scenario& s, StationId id) { return s.map->station(id).name; };
  const std::size_t half = scenario.map->segment_count() / 2;
  const Scenario less = with_segments(scenario, [&](std::size_t i) { return i < half; });
  EXPECT_EQ(less.map->segment_count(), half);
  EXPECT_LT(less.map->station_count(), scenario.map->station_count());
  for (std::size_t agv = 0; agv < 5; ++agv) {
    EXPECT_EQ(name_at(less, less.agvs[agv].start), name_at(scenario, scenario.agvs[agv].start));
    for (std::size_t i = 0; i < less.agvs[agv].transports.size(); ++i)
      EXPECT_EQ(name_at(less, less.agvs[agv].transports[i].to), name_at(scenario, scenario.agvs[agv].transports[i].to));
  }
  for (std::size_t i = 0; i < half; ++i) {
    EXPECT_EQ(less.map->layout().segments[i].name, scenario.map->layout().segments[i].name);
    EXPECT_EQ(name_at(less, less.map->layout().segments[i].from),
              name_at(scenario, scenario.map->layout().segments[i].from));
  }
}

}  // namespace
}  // namespace fleetproof::shrink_test
