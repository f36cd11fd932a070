// What the operator does about a fleet that stands still, one thing at a time.
#include "tests/core/helped.hpp"

namespace fleetproof::standstill_test {
namespace {

using test::bring_the_load;
using test::comes_after;
using test::fault;
using test::Heard;
using test::Helped;
using test::kStandstill;
using test::row_of_tens;
using test::run;
using test::somebody_in_the_way;

// Two AGVs that face each other, with a transport each. Their agents do nothing before they are restarted.
Scenario head_on(double horizon_s) {
  Scenario scenario = row_of_tens({1, 2}, horizon_s);
  scenario.agvs[1].heading = -Vec2::UnitX();
  scenario.agvs[0].transports = {{StationId{1U}, StationId{0U}, Duration{}}};
  scenario.agvs[1].transports = {{StationId{2U}, StationId{1U}, Duration{}}};
  scenario.stuck_after = seconds(30.0);
  return scenario;
}

void carry_once_restarted(const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
  if (b.boot == 0) return;
  if (e.kind == FP_EVENT_ORDER) host.pick(c, FP_HERE);
  std::uint32_t loaded = 0;
  if (e.kind == FP_EVENT_ACTION_DONE && host.is_loaded(c, &loaded) == FP_OK && loaded == 1)
    host.drop(c, b.self == 0 ? 0 : 1);
}

TEST(AtAStandstill, OneAgentAfterTheOtherIsRestartedUntilAllIsDone) {
  Scenario scenario = head_on(300.0);
  scenario.operator_help = comes_after(10.0);
  const Helped seen = run(scenario, carry_once_restarted);
  const auto assists = seen.assists(kStandstill);
  ASSERT_EQ(assists.size(), 2U);
  EXPECT_EQ(assists[0].entity, EntityId{0U}) << "of two that have done as little the first";
  EXPECT_NEAR(to_seconds(assists[0].at), 40.0, 1e-8);
  EXPECT_EQ(assists[1].entity, EntityId{1U});
  SimTime last_action = kStart;
  for (const TraceRecord& record : seen.trace.of(TraceKind::ActivityEnds)) {
    if (record.at < assists[1].at) last_action = record.at;
  }
  EXPECT_GE(to_seconds(assists[1].at - last_action), 40.0);
  EXPECT_LE(to_seconds(assists[1].at - last_action), 41.0) << "he looks every second";
  EXPECT_EQ(seen.outcome.counters.transports_done, 2U);
  EXPECT_EQ(seen.outcome.counters.assists, 2U);
  EXPECT_FALSE(seen.outcome.stuck);
  EXPECT_TRUE(seen.trace.of(TraceKind::Leaves).empty()) << "nobody is moved";
}

TEST(AtAStandstill, WithoutTheOperatorItLasts) {
  const Helped seen = run(head_on(300.0), carry_once_restarted);
  EXPECT_EQ(seen.outcome.counters.transports_done, 0U);
  EXPECT_EQ(seen.outcome.counters.assists, 0U);
  EXPECT_TRUE(seen.outcome.stuck);
}

TEST(AtAStandstill, ARunThatEndsWhileAnAgvChargesIsNotStuck) {
  Scenario scenario = head_on(300.0);
  for (const bool charges : {true, false}) {
    scenario.agvs[0].battery = 0.1;
    const Helped seen =
        run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
          if (charges && b.self == 0 && e.kind == FP_EVENT_START) host.charge(c, FP_HERE);
        });
    EXPECT_EQ(seen.outcome.stuck, !charges);
  }
}

TEST(AtAStandstill, ARunThatEndsDuringALongDriveIsNotStuck) {
  Scenario scenario = head_on(30.0);
  scenario.stuck_after = seconds(5.0);
  scenario.vehicle_types[0].drive.speed_mps = 0.3;
  for (const bool drives : {true, false}) {
    const Helped seen =
        run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
          if (drives && e.kind == FP_EVENT_START && b.self == 1) host.move(c, 2);
        });
    EXPECT_EQ(seen.outcome.stuck, !drives);
  }
}

TEST(AtAStandstill, WhereNoRestartHelpsTheyTakeTurnsAndTheRunIsStuck) {
  Scenario scenario = head_on(170.0);
  scenario.operator_help = comes_after(10.0);
  const Helped seen = run(scenario, [](const fp_host&, fp_controller*, const fp_briefing&, const fp_event&) {});
  const auto assists = seen.assists(kStandstill);
  ASSERT_EQ(assists.size(), 4U);
  for (std::size_t i = 0; i < assists.size(); ++i) {
    EXPECT_NEAR(to_seconds(assists[i].at), 40.0 * static_cast<double>(i + 1), 1e-8);
    EXPECT_EQ(assists[i].entity, EntityId{i % 2});
  }
  EXPECT_TRUE(seen.outcome.stuck) << "a restart is no action";
}

TEST(AtAStandstill, OneThatHasPassedNeedsNoHelp) {
  Scenario scenario = head_on(65.0);
  scenario.operator_help = comes_after(10.0);
  const Helped seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.self == 1) host.set_timer(c, 1, 32'000'000'000);
    if (e.kind == FP_EVENT_TIMER) host.pick(c, FP_HERE);  // over at 37 s; the operator comes at 40 s
  });
  EXPECT_TRUE(seen.assists(kStandstill).empty());
}

TEST(AtAStandstill, OnlyWhoHasSomethingToDoIsRestarted) {
  Scenario scenario = head_on(60.0);
  scenario.agvs[0].transports.clear();
  scenario.operator_help = comes_after(10.0);
  const Helped seen = run(scenario, carry_once_restarted);
  ASSERT_EQ(seen.assists(kStandstill).size(), 1U);
  EXPECT_EQ(seen.assists(kStandstill)[0].entity, EntityId{1U});
}

EntityId first_restarted(const Scenario& scenario, const test::Handler& handler) {
  const auto assists = run(scenario, handler).assists(kStandstill);
  return assists.empty() ? EntityId{} : assists[0].entity;
}

TEST(AtAStandstill, NoAgentIsRestartedThatIsGoneOrWhoseAgvCharges) {
  Scenario scenario = head_on(60.0);
  scenario.operator_help = comes_after(10.0);
  const test::Handler nothing = [](const fp_host&, fp_controller*, const fp_briefing&, const fp_event&) {};
  EXPECT_EQ(first_restarted(scenario, nothing), EntityId{0U});
  EXPECT_EQ(first_restarted(scenario,
                            [](const fp_host&, fp_controller*, const fp_briefing& b, const fp_event&) {
                              if (b.self == 0) throw std::runtime_error("crash");
                            }),
            EntityId{1U});
  scenario.faults = {fault(Fault::Kind::Restart, 20.0, 30.0)};
  EXPECT_EQ(first_restarted(scenario, nothing), EntityId{1U}) << "0 restarts by itself when he is called";
  scenario.faults = {fault(Fault::Kind::Restart, 35.0, 10.0)};
  EXPECT_EQ(first_restarted(scenario, nothing), EntityId{1U}) << "and here when he comes: he is called anew";
  scenario.faults.clear();
  scenario.agvs[0].battery = 0.1;
  EXPECT_EQ(first_restarted(scenario,
                            [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
                              if (b.self == 0 && e.kind == FP_EVENT_START) host.charge(c, FP_HERE);
                            }),
            EntityId{1U});
}

TEST(AtAStandstill, NobodyIsCalledBeforeThereIsSomethingToDo) {
  Scenario scenario = head_on(100.0);
  for (AgvSetup& agv : scenario.agvs) agv.transports[0].release = seconds(50.0);
  scenario.operator_help = comes_after(10.0);
  const Helped seen = run(scenario, carry_once_restarted);
  ASSERT_EQ(seen.assists(kStandstill).size(), 1U);
  EXPECT_NEAR(to_seconds(seen.assists(kStandstill)[0].at), 90.0, 1.0);
}

TEST(AtAStandstill, ALongDriveIsNone) {
  Scenario scenario = head_on(60.0);
  scenario.stuck_after = seconds(5.0);
  scenario.vehicle_types[0].drive.speed_mps = 0.3;  // more than half a minute from station to station
  scenario.operator_help = comes_after(2.0);
  const Helped seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.self == 1) host.move(c, 2);
  });
  ASSERT_FALSE(seen.assists(kStandstill).empty());
  EXPECT_GT(to_seconds(seen.assists(kStandstill)[0].at), 33.0 + 5.0);
}

TEST(AtAStandstill, NorIsARepair) {
  Scenario scenario = head_on(100.0);
  scenario.faults = {fault(Fault::Kind::Breakdown, 1.0, 60.0)};
  scenario.operator_help = comes_after(10.0);
  const Helped seen = run(scenario, carry_once_restarted);
  ASSERT_EQ(seen.assists(kStandstill).size(), 0U) << "not before 61 + 30 + 10 s";
}

TEST(AtAStandstill, NorIsWaitingForHelpAfterAContact) {
  int restarts = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Scenario scenario = somebody_in_the_way();
    scenario.agvs.push_back(scenario.agvs[0]);  // has something to do and never does it
    scenario.agvs[2].start = StationId{3U};
    scenario.seed = seed;
    scenario.stuck_after = seconds(5.0);
    scenario.operator_help = {.on = true, .least_s = 5.0, .most_s = 80.0};
    Heard heard;
    const Helped seen = run(scenario, bring_the_load(heard));
    const SimTime contact = seen.trace.of(TraceKind::Contact).at(0).at,
                  both_back = seen.trace.of(TraceKind::Appears).at(1).at;
    for (const TraceRecord& record : seen.assists(kStandstill)) {
      EXPECT_TRUE(record.at < contact || record.at > both_back) << "seed " << seed;
      restarts += record.entity == EntityId{2U} ? 1 : 0;
    }
  }
  EXPECT_GT(restarts, 0) << "afterwards";
}

TEST(AtAStandstill, HeIsCalledOnceAndComesWhenHeCan) {
  double sum_s = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Scenario scenario = head_on(300.0);
    scenario.seed = seed;
    scenario.operator_help = {.on = true, .least_s = 10.0, .most_s = 200.0};
    const double wait_s = to_seconds(run(scenario, carry_once_restarted).assists(kStandstill).at(0).at) - 30.0;
    EXPECT_GE(wait_s, 10.0);
    EXPECT_LE(wait_s, 200.0);
    sum_s += wait_s;
  }
  EXPECT_NEAR(sum_s / 20.0, 105.0, 40.0) << "uniform; three standard errors are 37 s";
}

}  // namespace
}  // namespace fleetproof::standstill_test
