// Laws where bodies appear and leave, loads fall and are cleared away, and faults hold AGVs.
#include <gtest/gtest.h>

#include "laws/laws.hpp"
#include "tests/support/worlds.hpp"

namespace fleetproof::coming_and_going_test {
namespace {

Outcome judged(const Scenario& scenario, const test::Handler& handler, std::string_view law) {
  std::vector<std::unique_ptr<Law>> laws;
  laws.push_back(find_law(law)->make(scenario));
  test::current_handler = &handler;
  Outcome outcome = simulate(scenario, test::handler_agent(), laws);
  test::current_handler = nullptr;
  return outcome;
}

Scenario row(std::vector<std::uint32_t> starts) {
  Scenario scenario = test::row_scenario(4, std::move(starts), 600.0);
  scenario.map = test::row_map(4, 10.0);
  scenario.stuck_after = seconds(60.0);
  return scenario;
}

const test::Handler kDoesNothing = [](const fp_host&, fp_controller*, const fp_briefing&, const fp_event&) {};

TEST(ComingAndGoing, TheJudgeSeesABodyFromItsAppearingToItsLeaving) {
  Scenario scenario = row({0});
  scenario.contact_stops = false;
  scenario.obstacles = {{"box",
                         {0.5, 0.5},
                         {Vec2{9.0, 0.6}, Vec2::UnitX()},
                         seconds(2.0),
                         seconds(100.0)}};  // beside the end of the lane: 0.15 m into it
  const auto violations = judged(
                              scenario,
                              [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
                                if (e.kind == FP_EVENT_START) host.move(c, 0);
                              },
                              "safety-distance")
                              .violations;
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].b, EntityId{1U});
  EXPECT_EQ(to_seconds(violations[0].last), 100.0) << "until it leaves";
  EXPECT_GT(to_seconds(violations[0].first), 5.0);
}

TEST(ComingAndGoing, NobodyWaitsForWhatHasNotAppeared) {
  Scenario scenario = row({0});
  scenario.agvs[0].transports = {{StationId{1U}, StationId{2U}, Duration{}}};
  scenario.obstacles = {{"late", {0.5, 0.5}, {Vec2{5.0, 0.0}, Vec2::UnitX()}, seconds(599.0)}};
  for (const Incident& incident : judged(scenario, kDoesNothing, "progress").incidents)
    EXPECT_FALSE(incident.b.valid()) << info_of(incident.kind).name;
}

Scenario load_that_falls() {
  Scenario scenario = row({0});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, Duration{}}};
  Fault drop;
  drop.kind = Fault::Kind::LoadDrop;
  drop.agv = AgvId{0U};
  drop.transport = 0;
  drop.at = seconds(3.0);
  drop.lasts = seconds(20.0);
  scenario.faults = {drop};
  return scenario;
}

const test::Handler kCarries = [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
  if (e.kind == FP_EVENT_ORDER) host.pick(c, FP_HERE);
  if (e.kind == FP_EVENT_ACTION_DONE && e.now_ns == 5'000'000'000) host.drop(c, 0);
};

TEST(ComingAndGoing, ALoadClearedAwayIsNobodysTaskAnyMore) {
  for (const char* law : {"progress", "normal-operation", "containment"}) {
    const Outcome outcome = judged(load_that_falls(), kCarries, law);
    EXPECT_EQ(outcome.counters.loads_cleared, 1U);
    EXPECT_TRUE(outcome.incidents.empty()) << law << ": " << info_of(outcome.incidents.front().kind).name;
  }
}

TEST(ComingAndGoing, ABreakdownExcusesTheFleet) {
  Scenario scenario = row({0});
  scenario.agvs[0].transports = {{StationId{1U}, StationId{2U}, Duration{}}};
  Fault breakdown;
  breakdown.agv = AgvId{0U};
  breakdown.at = seconds(3.0);
  breakdown.lasts = seconds(300.0);
  scenario.faults = {breakdown};
  const test::Handler carries = [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
    if (e.kind == FP_EVENT_ORDER) host.pick(c, 0);
    if (e.kind == FP_EVENT_ACTION_DONE) host.drop(c, 1);
  };
  for (const char* law : {"progress", "normal-operation"}) {
    const Outcome outcome = judged(scenario, carries, law);
    EXPECT_EQ(outcome.counters.transports_done, 1U);
    EXPECT_TRUE(outcome.incidents.empty()) << law << ": " << info_of(outcome.incidents.front().kind).name;
  }
  EXPECT_FALSE(judged(scenario, kDoesNothing, "progress").incidents.empty())
      << "but not one who does nothing when it is over";
}

TEST(ComingAndGoing, AChangedBatteryClosesTheIncident) {
  Scenario scenario = row({0});
  scenario.vehicle_types[0].battery_per_m = 0.01;
  scenario.agvs[0].battery = 0.04;
  scenario.operator_help = {.on = true, .least_s = 10.0, .most_s = 10.0, .battery = 0.5};
  const auto incidents = judged(
                             scenario,
                             [](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
                               if (e.kind == FP_EVENT_START) host.move(c, 0);
                             },
                             "battery")
                             .incidents;
  ASSERT_EQ(incidents.size(), 1U);
  EXPECT_NEAR(to_seconds(incidents[0].first), 4.0, 1e-6);
  EXPECT_NEAR(to_seconds(incidents[0].last), 14.0, 1e-6);
}

}  // namespace
}  // namespace fleetproof::coming_and_going_test
