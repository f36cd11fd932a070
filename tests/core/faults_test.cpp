// What goes wrong, one fault at a time.
#include "tests/core/row_of_tens.hpp"

namespace fleetproof::faults_test {
namespace {

using test::drive_and_look;
using test::fault;
using test::row_of_tens;
using test::Seen;

TEST(Halt, AProtectiveStopBrakesStandsAndGoesOn) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 3.0, 5.0)};
  // At 3 s: 1.5 m/s and 2.25 m on. 1.5 s of braking end at 3.375 m. From 8 s on: 6.625 m from rest, 6 s of ramps and
  // 0.3125 s level.
  const Seen seen = drive_and_look(scenario, {3.0, 4.5, 6.0, 8.0, 9.0});
  ASSERT_EQ(seen.done_s.size(), 1U);
  EXPECT_NEAR(seen.done_s[0], 14.3125, 1e-8);
  EXPECT_NEAR(seen.x_m[1], 3.375, 1e-8);
  EXPECT_EQ(seen.x_m[2], seen.x_m[1]);
  EXPECT_NEAR(seen.x_m[4], 3.375 + 0.25, 1e-8);
  EXPECT_EQ(seen.actions[2], static_cast<std::uint32_t>(FP_STOPPED));
  EXPECT_EQ(seen.actions[4], static_cast<std::uint32_t>(FP_DRIVING));
  EXPECT_EQ(seen.outcome.counters.faults, 1U);
  EXPECT_EQ(seen.outcome.counters.distance_um, 10'000'000U);
  EXPECT_EQ(seen.trace.of(TraceKind::FaultStrikes).size(), 1U);
  EXPECT_EQ(seen.trace.of(TraceKind::FaultOver).size(), 1U);
}

TEST(Halt, OverBeforeItStandsItSpeedsUpAgain) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 3.0, 0.5)};
  // 3.5 s: 1 m/s, 2.875 m. Then 2 s up (3 m), 1.0625 s level, 2 s down (2 m).
  const Seen seen = drive_and_look(scenario);
  ASSERT_EQ(seen.done_s.size(), 1U);
  EXPECT_NEAR(seen.done_s[0], 8.5625, 1e-8);
}

TEST(Halt, TwoAtOnceLastUntilTheLaterIsOver) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 3.0, 5.0), fault(Fault::Kind::Breakdown, 4.0, 6.0)};
  const Seen seen = drive_and_look(scenario, {9.0});
  EXPECT_NEAR(seen.done_s.at(0), 16.3125, 1e-8);
  EXPECT_EQ(seen.actions.at(0), static_cast<std::uint32_t>(FP_OUT_OF_ORDER));
}

TEST(Halt, StrikingAnIdleAgvItHoldsTheNextActionBack) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::Breakdown, 0.0, 10.0)};
  const Seen seen = drive_and_look(scenario);
  EXPECT_NEAR(seen.done_s.at(0), 18.0, 1e-8);
}

TEST(Halt, ATransferBeginsAgain) {
  Scenario scenario = row_of_tens({0});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, Duration{}}};
  scenario.faults = {fault(Fault::Kind::Breakdown, 4.0, 10.0)};
  std::vector<std::int64_t> done;
  test::Recorder trace;
  test::simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind == FP_EVENT_ORDER) {
          EXPECT_EQ(host.pick(c, FP_HERE), FP_OK);
        }
        if (e.kind == FP_EVENT_ACTION_DONE) done.push_back(e.now_ns);
      },
      &trace);
  EXPECT_EQ(done, (std::vector<std::int64_t>{19'000'000'000}));
  EXPECT_EQ(trace.of(TraceKind::LoadMoves).size(), 2U) << "it appears at the station and is taken once";
}

TEST(Halt, RollingOnItBrakesAcrossTheStation) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {
      fault(Fault::Kind::ProtectiveStop, 6.5, 3.0)};  // 1 m before the station at 2 m/s: 2 m are needed to stand
  std::vector<double> done_s;
  double stands_at_m = 0.0;
  const Outcome outcome =
      test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind == FP_EVENT_START) {
          host.move(c, 0);
          host.move(c, 1);
          host.set_timer(c, 1, 9'000'000'000);
        }
        if (e.kind == FP_EVENT_ACTION_DONE) done_s.push_back(static_cast<double>(e.now_ns) * 1e-9);
        fp_pose pose{};
        if (e.kind == FP_EVENT_TIMER && host.get_position(c, &pose) == FP_OK) stands_at_m = pose.x_m;
      });
  EXPECT_NEAR(stands_at_m, 11.0, 1e-8);
  ASSERT_EQ(done_s.size(), 2U);
  EXPECT_GT(done_s[0], 7.0);
  EXPECT_LT(done_s[0], 7.5);
  EXPECT_NEAR(done_s[1], 9.5 + 7.5, 1e-7) << "9 m from rest";
  EXPECT_EQ(outcome.counters.distance_um, 20'000'000U);
}

TEST(Battery, RunsEmptyOnTheWayAndTheAgvStandsForGood) {
  Scenario scenario = row_of_tens({0});
  scenario.vehicle_types[0].battery_per_m = 0.01;
  scenario.agvs[0].battery = 0.04;  // 4 m: at 4 s, 2 m/s fast; 2 m of braking
  const Seen seen = drive_and_look(scenario, {7.0, 50.0});
  EXPECT_TRUE(seen.done_s.empty());
  EXPECT_NEAR(seen.x_m[0], 6.0, 1e-7);
  EXPECT_EQ(seen.x_m[1], seen.x_m[0]);
  EXPECT_EQ(seen.actions[1], static_cast<std::uint32_t>(FP_OUT_OF_ORDER));
  const auto empty = seen.trace.of(TraceKind::BatteryEmpty);
  ASSERT_EQ(empty.size(), 1U);
  EXPECT_NEAR(to_seconds(empty[0].at), 4.0, 1e-8);
  EXPECT_EQ(seen.outcome.counters.batteries_empty, 1U);
  EXPECT_EQ(seen.outcome.counters.battery_end_ppb, 0U);
  EXPECT_EQ(seen.outcome.counters.battery_driven_ppb, 40'000'000U);
}

TEST(Battery, TheOperatorChangesIt) {
  Scenario scenario = row_of_tens({0});
  scenario.vehicle_types[0].battery_per_m = 0.01;
  scenario.agvs[0].battery = 0.04;
  scenario.operator_help = {.on = true, .least_s = 10.0, .most_s = 10.0, .battery = 0.5};
  const Seen seen = drive_and_look(scenario);
  ASSERT_EQ(seen.done_s.size(), 1U);
  EXPECT_NEAR(seen.done_s[0], 14.0 + 4.898979485566356, 1e-7) << "4 m from rest";
  EXPECT_EQ(seen.outcome.counters.assists, 1U);
  EXPECT_NEAR(static_cast<double>(seen.outcome.counters.battery_end_ppb), 0.46e9, 2.0);
}

TEST(Battery, IsUsedUpByStandingToo) {
  Scenario scenario = row_of_tens({0});
  scenario.vehicle_types[0].battery_idle_per_s = 0.01;
  scenario.agvs[0].battery = 0.3;
  const Outcome outcome =
      test::simulate_with(scenario, [](const fp_host&, fp_controller*, const fp_briefing&, const fp_event&) {});
  EXPECT_EQ(outcome.counters.batteries_empty, 1U);
  EXPECT_EQ(outcome.counters.battery_idled_ppb, 300'000'000U);
}

TEST(LoadDrop, TheLoadLiesBehindAndIsClearedAway) {
  Scenario scenario = row_of_tens({0});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, Duration{}}};
  Fault drop = fault(Fault::Kind::LoadDrop, 4.0, 20.0);
  drop.transport = 0;  // 4 s after the pick at 5 s: 4 m on
  scenario.faults = {drop};
  test::Recorder trace;
  std::uint32_t loaded = 9;
  const Outcome outcome = test::simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind == FP_EVENT_ORDER) host.pick(c, FP_HERE);
        if (e.kind == FP_EVENT_ACTION_DONE && e.now_ns == 5'000'000'000) host.drop(c, 0);
        if (e.kind == FP_EVENT_ACTION_DONE) host.is_loaded(c, &loaded);
      },
      &trace);
  EXPECT_EQ(loaded, 0U);
  EXPECT_EQ(outcome.counters.faults, 1U);
  EXPECT_EQ(outcome.counters.loads_cleared, 1U);
  EXPECT_EQ(outcome.counters.transports_done, 0U);
  EXPECT_FALSE(outcome.stuck) << "nothing is left to do";
  const auto appears = trace.of(TraceKind::Appears), leaves = trace.of(TraceKind::Leaves);
  ASSERT_EQ(appears.size(), 1U);
  ASSERT_EQ(leaves.size(), 1U);
  EXPECT_EQ(appears[0].entity, EntityId{1U});
  EXPECT_EQ(to_seconds(leaves[0].at - appears[0].at), 20.0);
  const auto moves = trace.of(TraceKind::LoadMoves);
  ASSERT_EQ(moves.size(), 4U) << "appears, taken, fallen, cleared";
  EXPECT_EQ(moves[2].b >> 32, static_cast<std::uint64_t>(Holder::Kind::Floor));
  EXPECT_EQ(moves[3].b >> 32, static_cast<std::uint64_t>(Holder::Kind::ClearedAway));
}

TEST(LoadDrop, WhoDrivesIntoItTouchesIt) {
  Scenario scenario = row_of_tens({0, 3});
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, Duration{}}};
  scenario.agvs[1].heading = -Vec2::UnitX();
  Fault drop = fault(Fault::Kind::LoadDrop, 1.0, 1000.0);
  drop.transport = 0;
  drop.ahead_m = 3.0;  // thrown forward
  scenario.faults = {drop};
  const Outcome outcome = test::simulate_with(
      scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
        if (b.self == 0 && e.kind == FP_EVENT_ORDER) host.pick(c, FP_HERE);
        if (b.self == 0 && e.kind == FP_EVENT_ACTION_DONE && e.result == FP_OK) host.move(c, 0);
      });
  EXPECT_EQ(outcome.counters.contacts, 1U);
  EXPECT_TRUE(outcome.contact);
}

TEST(Obstacle, AppearsWhenItsPlaceIsFreeAndLeaves) {
  Scenario scenario = row_of_tens({0});
  scenario.obstacles = {
      {"box", {0.5, 0.5}, {Vec2{0.0, 0.0}, Vec2::UnitX()}, seconds(1.0), seconds(30.0)}};  // where the AGV starts
  const Seen seen = drive_and_look(scenario);
  const auto appears = seen.trace.of(TraceKind::Appears);
  ASSERT_EQ(appears.size(), 1U);
  // Clear by 0.15 m once the AGV is 0.8 + 0.25 + 0.15 m away: after 2.19 s; it is tried every second.
  EXPECT_EQ(to_seconds(appears[0].at), 3.0);
  ASSERT_EQ(seen.trace.of(TraceKind::Leaves).size(), 1U);
  EXPECT_EQ(seen.outcome.counters.contacts, 0U);
}

TEST(Halt, ACallThatTakesEffectWhileItStandsInMidSegmentWaitsForItsTurn) {
  Scenario scenario = row_of_tens({0});
  scenario.agent_clock.call_cost_s = 2.0;
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 6.0, 10.0)};
  std::vector<double> done_s;
  const Outcome outcome =
      test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind == FP_EVENT_START) {
          host.move(c, 0);
          host.set_timer(c, 1, 7'000'000'000);  // it brakes; the call takes effect when it stands
        }
        if (e.kind == FP_EVENT_TIMER) {
          EXPECT_EQ(host.move(c, 1), FP_OK);
        }
        if (e.kind == FP_EVENT_ACTION_DONE) done_s.push_back(static_cast<double>(e.now_ns) * 1e-9);
      });
  EXPECT_EQ(done_s.size(), 2U);
  EXPECT_EQ(outcome.counters.distance_um, 20'000'000U);
}

TEST(Freeze, EventsWaitUntilItIsOver) {
  Scenario scenario = row_of_tens({0});
  scenario.faults = {fault(Fault::Kind::Freeze, 7.0, 5.0)};
  const Seen seen = drive_and_look(scenario);
  EXPECT_EQ(seen.done_s, (std::vector<double>{12.0}));
}

TEST(Freeze, AnotherOneHoldsOnUntilTheLaterIsOver) {
  Scenario scenario = row_of_tens({0}, 100.0);
  scenario.faults = {fault(Fault::Kind::Freeze, 1.0, 2.0), fault(Fault::Kind::Freeze, 2.5, 50.0)};
  const Seen seen = drive_and_look(scenario, {1.5});
  ASSERT_EQ(seen.x_m.size(), 1U);
  EXPECT_EQ(seen.x_m[0], 10.0) << "not at 3 s on the way, when the first is over";
  EXPECT_EQ(seen.done_s, (std::vector<double>{52.5}));
}

TEST(Faults, CountedFromAPickTheyStrikeOnce) {
  Scenario scenario = row_of_tens({0}, 200.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{2U}, Duration{}}};
  Fault stop = fault(Fault::Kind::ProtectiveStop, 1.0, 30.0);
  stop.transport = 0;
  scenario.faults = {stop};
  int done = 0;
  test::Recorder trace;
  test::simulate_with(
      scenario,
      [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind == FP_EVENT_ORDER) host.pick(c, FP_HERE);
        if (e.kind != FP_EVENT_ACTION_DONE) return;
        if (++done == 1) host.drop(c, 0);  // at the wrong station
        if (done == 2) host.pick(c, FP_HERE);
        if (done == 3) host.drop(c, 1);
      },
      &trace);
  EXPECT_EQ(done, 4) << "and the AGV goes on after it";
  EXPECT_EQ(trace.of(TraceKind::FaultStrikes).size(), 1U);
  EXPECT_EQ(trace.of(TraceKind::TransportDone).size(), 1U);
}

// A drive that goes on in the middle: way_begin + (length - way_begin) may be one rounding step beyond the length.
TEST(Halt, InTheLastNanosecondOfALaneRoundingIsNoEngineError) {
  Scenario scenario = row_of_tens({0});
  scenario.map = test::row_map(2, 25.673104652307796);
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 5.640971823, 10.0),
                     fault(Fault::Kind::ProtectiveStop, 27.836552326, 1.0)};
  int done = 0;
  const Outcome outcome =
      test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing&, const fp_event& e) {
        if (e.kind == FP_EVENT_START) host.set_timer(c, 1, 1'000'000'000);
        if (e.kind == FP_EVENT_TIMER) host.move(c, 0);
        if (e.kind == FP_EVENT_ACTION_DONE) ++done;
      });
  EXPECT_FALSE(outcome.engine_error) << outcome.message;
  EXPECT_EQ(done, 1);
}

TEST(Halt, WhoIsHitWhileHeldIsOutOfOrder) {
  Scenario scenario = row_of_tens({0, 1});
  scenario.agvs[1].heading = -Vec2::UnitX();
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 1.0, 50.0)};
  std::uint32_t action = 0;
  test::simulate_with(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START) host.move(c, 0);
    if (b.self == 0 && e.kind == FP_EVENT_START) host.set_timer(c, 1, 40'000'000'000);
    if (b.self == 0 && e.kind == FP_EVENT_TIMER) host.get_action(c, &action);
  });
  EXPECT_EQ(action, static_cast<std::uint32_t>(FP_OUT_OF_ORDER));
}

TEST(Faults, AnAgvThatIsOutOfOrderForGoodCannotFail) {
  Scenario scenario = row_of_tens({0, 1});
  scenario.faults = {fault(Fault::Kind::Breakdown, 30.0, 5.0)};
  const Seen seen = drive_and_look(scenario);
  EXPECT_EQ(seen.outcome.counters.contacts, 1U);
  EXPECT_EQ(seen.outcome.counters.faults, 0U);
}

}  // namespace
}  // namespace fleetproof::faults_test
