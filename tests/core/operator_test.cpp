// What the operator does about contacts and standstills, one at a time.
#include "tests/core/row_of_tens.hpp"

namespace fleetproof {
namespace {

using test::fault;
using test::row_of_tens;

constexpr auto kContact = static_cast<std::uint64_t>(Assist::Contact), kBattery = static_cast<std::uint64_t>(Assist::Battery),
               kStandstill = static_cast<std::uint64_t>(Assist::Standstill);

OperatorSetup comes_after(double help_s) { return {.on = true, .least_s = help_s, .most_s = help_s, .battery = 0.5}; }

struct Helped {
  Outcome outcome;
  test::Recorder trace;

  std::vector<TraceRecord> assists(std::uint64_t what) const {
    auto found = trace.of(TraceKind::OperatorAssists);
    std::erase_if(found, [&](const TraceRecord& record) { return record.a != what; });
    return found;
  }
  // When an AGV is set down again, in seconds after the first contact.
  double set_down_s(EntityId agv) const {
    for (const TraceRecord& record : trace.of(TraceKind::Appears)) {
      if (record.entity == agv) return to_seconds(record.at - trace.of(TraceKind::Contact).at(0).at);
    }
    return -1.0;
  }
  std::uint64_t set_down_at(EntityId agv) const {
    for (const TraceRecord& record : trace.of(TraceKind::Appears)) {
      if (record.entity == agv) return record.a;
    }
    return 999;
  }
};

Helped run(const Scenario& scenario, const test::Handler& handler) {
  Helped seen;
  seen.outcome = test::simulate_with(scenario, handler, &seen.trace);
  EXPECT_FALSE(seen.outcome.engine_error) << seen.outcome.message;
  return seen;
}

// AGV 0 brings a load from station 0 to station 2; AGV 1 stands in its way at station 1 and never does anything.
Scenario somebody_in_the_way() {
  Scenario scenario = row_of_tens({0, 1}, 200.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{2U}, Duration{}}};
  return scenario;
}

struct Told {
  std::vector<std::uint32_t> boots, stations, segments, loaded, actions;
  std::vector<double> at_s;
  int orders = 0;
};

// Of AGV 0: it drives on with its load from wherever it starts.
test::Handler bring_the_load(Told& told) {
  return [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self != 0) return;
    std::uint32_t loaded = 0, action = 0;
    host.is_loaded(c, &loaded);
    host.get_action(c, &action);
    if (e.kind == FP_EVENT_START) {
      told.boots.push_back(b.boot);
      told.stations.push_back(b.start_station);
      told.segments.push_back(b.start_segment);
      told.loaded.push_back(loaded);
      told.actions.push_back(action);
      told.at_s.push_back(static_cast<double>(e.now_ns) * 1e-9);
    }
    if (e.kind == FP_EVENT_ORDER) {
      ++told.orders;
      if (loaded == 0) host.pick(c, FP_HERE);
      if (loaded == 1) host.drop(c, 1);
    }
    if (e.kind == FP_EVENT_ACTION_DONE && e.result == FP_OK && loaded == 1 && b.boot == 0) host.move(c, 0);
  };
}

TEST(AfterAContact, TheAgvIsSetDownAtTheEndOfItsSegmentAndDelivers) {
  Scenario scenario = somebody_in_the_way();
  scenario.operator_help = comes_after(20.0);
  Told told;
  const Helped seen = run(scenario, bring_the_load(told));
  EXPECT_EQ(seen.outcome.counters.contacts, 1U);
  EXPECT_TRUE(seen.outcome.contact) << "help undoes nothing";
  EXPECT_EQ(seen.outcome.counters.assists, 2U);
  const auto assists = seen.assists(kContact);
  ASSERT_EQ(assists.size(), 2U);
  EXPECT_NEAR(to_seconds(assists[0].at - seen.trace.of(TraceKind::Contact).at(0).at), 20.0, 1e-8);
  EXPECT_EQ(seen.trace.of(TraceKind::Leaves).size(), 2U);
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 1U);
  EXPECT_NEAR(seen.set_down_s(EntityId{0U}), 21.0, 1e-8);
  EXPECT_EQ(told.boots, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(told.stations, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(told.segments, (std::vector<std::uint32_t>{FP_NONE, FP_NONE}));
  EXPECT_EQ(told.loaded, (std::vector<std::uint32_t>{0, 1})) << "it keeps its load";
  EXPECT_EQ(told.actions.at(1), static_cast<std::uint32_t>(FP_IDLE));
  EXPECT_EQ(told.orders, 2) << "told again";
  EXPECT_EQ(seen.outcome.counters.transports_done, 1U);
  EXPECT_FALSE(seen.outcome.stuck);
}

TEST(AfterAContact, WhoseStationIsTakenComesToTheNearestThatIsFree) {
  Scenario scenario = somebody_in_the_way();
  scenario.operator_help = comes_after(20.0);
  Told told;
  const Helped seen = run(scenario, bring_the_load(told));
  EXPECT_EQ(seen.set_down_at(EntityId{1U}), 0U) << "AGV 0 stands at station 1 by then; 0 and 2 are as near, and 0 is the first";
}

TEST(AfterAContact, WithoutTheOperatorItStandsForGood) {
  Told told;
  const Helped seen = run(somebody_in_the_way(), bring_the_load(told));
  EXPECT_EQ(seen.outcome.counters.contacts, 1U);
  EXPECT_EQ(seen.outcome.counters.assists, 0U);
  EXPECT_EQ(seen.outcome.counters.transports_done, 0U);
  EXPECT_TRUE(seen.trace.of(TraceKind::Leaves).empty());
  EXPECT_TRUE(seen.outcome.stuck);
}

TEST(AfterAContact, WhoStoodAtItsStationComesBackThereAsItStood) {
  Scenario scenario = row_of_tens({1, 0}, 100.0);
  scenario.agvs[0].heading = Vec2::UnitY();
  scenario.operator_help = comes_after(20.0);
  fp_pose pose{};
  const Helped seen = run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind != FP_EVENT_START) return;
    if (b.self == 1 && b.boot == 0) host.move(c, 0);
    if (b.self == 0 && b.boot == 1) host.get_position(c, &pose);
  });
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 1U);
  EXPECT_EQ(pose.x_m, 10.0);
  EXPECT_EQ(pose.heading_y, 1.0);
}

// A box in the middle of the way of AGV 0.
Scenario box_in_the_way(std::vector<std::uint32_t> starts) {
  Scenario scenario = row_of_tens(std::move(starts), 120.0);
  scenario.obstacles = {{"box", {0.5, 0.5}, {Vec2{5.0, 0.0}, Vec2::UnitX()}}};
  scenario.operator_help = comes_after(20.0);
  return scenario;
}

TEST(AfterAContact, AnOccupiedPlaceDelaysTheSetDown) {
  Scenario scenario = box_in_the_way({0});
  scenario.map = test::row_map(2, 10.0);
  scenario.obstacles.push_back({"behind", {0.5, 0.5}, {Vec2{0.0, 0.0}, Vec2::UnitX()}, seconds(3.0)});
  scenario.obstacles.push_back({"ahead", {0.5, 0.5}, {Vec2{11.14, 0.0}, Vec2::UnitX()}, Duration{}, seconds(50.5)});  // 9 cm from its front
  const Helped seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.boot == 0) host.move(c, 0);
  });
  const double contact_s = to_seconds(seen.trace.of(TraceKind::Contact).at(0).at);
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 1U);
  EXPECT_GE(contact_s + seen.set_down_s(EntityId{0U}), 50.5);
  EXPECT_LT(contact_s + seen.set_down_s(EntityId{0U}), 51.5);
  EXPECT_EQ(seen.outcome.counters.assists, 1U) << "he looks again, and is not called again";
}

TEST(AfterAContact, ThatFarFromItThePlaceIsFree) {
  Scenario scenario = box_in_the_way({0});
  scenario.obstacles.push_back({"ahead", {0.5, 0.5}, {Vec2{11.15, 0.0}, Vec2::UnitX()}});  // 10 cm
  const Helped seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.boot == 0) host.move(c, 0);
  });
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 1U);
  EXPECT_NEAR(seen.set_down_s(EntityId{0U}), 21.0, 1e-8);
}

TEST(AfterAContact, SoItIsBesideAnObliqueWallWhoseBoxReachesIntoIt) {
  Scenario scenario = box_in_the_way({0});
  scenario.obstacles.push_back({"wall", {2.0, 0.02}, {Vec2{11.012, 0.712}, Vec2{1.0, -1.0}.normalized()}});  // 0.29 m from its front left corner
  const Helped seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.boot == 0) host.move(c, 0);
  });
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 1U);
}

TEST(AfterAContact, NobodyIsSetDownInFrontOfOneThatDrives) {
  Scenario scenario = box_in_the_way({0, 2});
  scenario.agvs[1].heading = -Vec2::UnitX();
  const Helped seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.self == 0 && b.boot == 0) host.move(c, 0);
    if (e.kind == FP_EVENT_START && b.self == 1) host.set_timer(c, 1, 24'000'000'000);
    if (e.kind == FP_EVENT_TIMER) host.move(c, 1);  // to station 1, to which AGV 0 was driving
  });
  const double set_down_s = to_seconds(seen.trace.of(TraceKind::Contact).at(0).at) + seen.set_down_s(EntityId{0U});
  EXPECT_GT(set_down_s, 24.0);
  EXPECT_LT(set_down_s, 26.0) << "or AGV 1 was not far away";
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 0U);
  EXPECT_EQ(seen.outcome.counters.contacts, 1U);
}

TEST(AfterAContact, TheSameTwoMayTouchAgain) {
  Scenario scenario = row_of_tens({0, 1}, 100.0);
  scenario.operator_help = comes_after(20.0);
  const Helped seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.self == 0 && b.boot < 2) host.move(c, 0);
  });
  EXPECT_EQ(seen.outcome.counters.contacts, 2U) << "0 at station 1 drives back to station 0, where 1 stands by then";
  EXPECT_EQ(seen.assists(kContact).size(), 4U);
}

TEST(AfterAContact, WhatHeldTheAgvHoldsItNoLonger) {
  Scenario scenario = row_of_tens({1, 0}, 200.0);
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 1.0, 150.0)};
  scenario.operator_help = comes_after(20.0);
  std::vector<double> done_s;
  const Helped seen = run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.self == 1 && b.boot == 0) host.move(c, 0);
    if (b.self != 0) return;
    if (e.kind == FP_EVENT_START && b.boot == 0) host.set_timer(c, 1, 2'000'000'000);
    if (e.kind == FP_EVENT_TIMER || (e.kind == FP_EVENT_START && b.boot == 1)) {
      EXPECT_EQ(host.move(c, 1), FP_OK);  // the first of them waits for the end of the stop
    }
    if (e.kind == FP_EVENT_ACTION_DONE && e.result == FP_OK) done_s.push_back(static_cast<double>(e.now_ns) * 1e-9);
  });
  const double set_down_s = to_seconds(seen.trace.of(TraceKind::Contact).at(0).at) + seen.set_down_s(EntityId{0U});
  ASSERT_EQ(done_s.size(), 1U);
  EXPECT_NEAR(done_s[0], set_down_s + 8.0, 1e-8);
}

TEST(AfterAContact, WhatItWasAboutToDoIsForgotten) {
  Scenario scenario = row_of_tens({1, 0}, 200.0);
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 1.0, 150.0), fault(Fault::Kind::ProtectiveStop, 60.0, 5.0)};
  scenario.operator_help = comes_after(20.0);
  int done = 0;
  const Helped seen = run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.self == 1 && b.boot == 0) host.move(c, 0);
    if (b.self == 0 && e.kind == FP_EVENT_START && b.boot == 0) host.set_timer(c, 1, 2'000'000'000);
    if (b.self == 0 && e.kind == FP_EVENT_TIMER) host.move(c, 1);  // waits for the end of the stop, and is hit meanwhile
    if (b.self == 0 && b.boot == 1 && e.kind == FP_EVENT_ACTION_DONE) ++done;
  });
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 1U);
  EXPECT_EQ(done, 0) << "the end of the second stop ends nothing else";
}

TEST(AfterAContact, HeldInMidSegmentItStandsOnThatSegment) {
  Scenario scenario = row_of_tens({0, 1}, 100.0);
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 3.0, 90.0)};  // it stands at 3.375 m
  scenario.agvs[1].heading = -Vec2::UnitX();
  scenario.operator_help = comes_after(20.0);
  fp_pose pose{};
  const Helped seen = run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind != FP_EVENT_START) return;
    if (b.boot == 0) host.set_timer(c, 1, 0);
    if (b.boot == 0) host.move(c, 0);
    if (b.boot == 1 && b.self == 0) host.get_position(c, &pose);
  });
  EXPECT_EQ(seen.outcome.counters.contacts, 1U);
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 1U);
  EXPECT_EQ(pose.x_m, 10.0);
}

TEST(AfterAContact, ALatePositionIsNotOfWhereItWas) {
  Scenario scenario = somebody_in_the_way();
  scenario.agvs[0].sensing.position_late_s = 60.0;
  scenario.operator_help = comes_after(20.0);
  fp_pose pose{};
  run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self != 0 || e.kind != FP_EVENT_START) return;
    if (b.boot == 0) host.move(c, 0);
    if (b.boot == 1) host.get_position(c, &pose);
  });
  EXPECT_EQ(pose.x_m, 10.0);
}

TEST(AfterAContact, TheSetDownIsProgressAsTheEndOfAnyHaltIs) {
  Scenario scenario = somebody_in_the_way();
  scenario.operator_help = comes_after(100.0);
  scenario.stuck_after = seconds(30.0);
  scenario.horizon = seconds(130.0);
  const auto nothing_more = [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 0 && b.boot == 0 && e.kind == FP_EVENT_START) host.move(c, 0);
  };
  EXPECT_FALSE(run(scenario, nothing_more).outcome.stuck);
  scenario.horizon = seconds(150.0);
  EXPECT_TRUE(run(scenario, nothing_more).outcome.stuck);
}

TEST(AfterAContact, ItsScannerIsNoLongerMuted) {
  Scenario scenario = row_of_tens({0, 1});
  scenario.agvs[1].heading = Vec2::UnitY();
  scenario.obstacles = {{"box", {0.5, 0.5}, {Vec2{11.17, 0.0}, Vec2::UnitX()}}};  // 12 cm before the AGV at station 1: in its field, and no nearer than it may be
  scenario.scanner.on = true;
  scenario.operator_help = comes_after(10.0);
  const Helped seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 0 && e.kind == FP_EVENT_START) host.move(c, b.boot);
  });
  const auto contacts = seen.trace.of(TraceKind::Contact);
  ASSERT_FALSE(contacts.empty()) << "sent on, it drives into AGV 1";
  const double set_down_s = seen.set_down_s(EntityId{0U});
  EXPECT_GT(set_down_s, 0.0);
  for (std::size_t i = 1; i < contacts.size(); ++i) EXPECT_GT(to_seconds(contacts[i].at - contacts[0].at), set_down_s + 9.0) << "before anybody mutes it again";
}

TEST(AfterAContact, AnEmptyBatteryIsChangedOnTheOccasion) {
  Scenario scenario = somebody_in_the_way();
  scenario.vehicle_types[0].battery_idle_per_s = 0.01;
  scenario.agvs[0].battery = 0.2;
  scenario.operator_help = comes_after(30.0);
  Told told;
  const Helped seen = run(scenario, bring_the_load(told));
  const auto changed = seen.assists(kBattery);
  ASSERT_GE(changed.size(), 1U);
  EXPECT_EQ(changed[0].entity, EntityId{0U});
  EXPECT_NEAR(to_seconds(changed[0].at - seen.trace.of(TraceKind::Contact).at(0).at), 31.0, 1e-8) << "where it is set down";
  EXPECT_EQ(seen.outcome.counters.transports_done, 1U);
  const Counters& c = seen.outcome.counters;
  EXPECT_NEAR(static_cast<double>(c.battery_start_ppb + c.battery_charged_ppb),
              static_cast<double>(c.battery_end_ppb + c.battery_driven_ppb + c.battery_idled_ppb), 5.0);
}

TEST(AfterAContact, AnAgentThatIsRestartingStartsWhenItsAgvStandsAndTheRestartIsOver) {
  for (const double lasts_s : {21.7, 60.0}) {  // over while the AGV is off the floor, and after it has been set down
    Scenario scenario = somebody_in_the_way();
    scenario.faults = {fault(Fault::Kind::Restart, 10.0, lasts_s)};
    scenario.operator_help = comes_after(20.0);
    Told told;
    const Helped seen = run(scenario, bring_the_load(told));
    const double set_down_s = to_seconds(seen.trace.of(TraceKind::Contact).at(0).at) + seen.set_down_s(EntityId{0U});
    EXPECT_GT(set_down_s, 31.7);
    EXPECT_LT(set_down_s - 1.0, 31.7);
    EXPECT_EQ(told.boots, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_NEAR(told.at_s.at(1), std::max(set_down_s, 10.0 + lasts_s), 1e-8);
    EXPECT_EQ(seen.outcome.counters.transports_done, 1U);
  }
}

TEST(AfterAContact, ACrashedAgentStaysCrashed) {
  Scenario scenario = row_of_tens({0, 1}, 100.0);
  scenario.operator_help = comes_after(20.0);
  int starts = 0;
  const Helped seen = run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self != 0 || e.kind != FP_EVENT_START) return;
    ++starts;
    host.move(c, 0);
    throw std::runtime_error("on its way");
  });
  EXPECT_EQ(starts, 1);
  EXPECT_TRUE(seen.outcome.crash);
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 1U);
}

// ---- standstills

// Two who face each other, with a transport each, and whose agents do nothing before they are restarted.
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
  if (e.kind == FP_EVENT_ACTION_DONE && host.is_loaded(c, &loaded) == FP_OK && loaded == 1) host.drop(c, b.self == 0 ? 0 : 1);
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
    if (e.kind == FP_EVENT_TIMER) host.pick(c, FP_HERE);  // over at 37 s; he comes at 40 s
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
  EXPECT_EQ(first_restarted(scenario, [](const fp_host&, fp_controller*, const fp_briefing& b, const fp_event&) {
    if (b.self == 0) throw std::runtime_error("crash");
  }), EntityId{1U});
  scenario.faults = {fault(Fault::Kind::Restart, 20.0, 30.0)};
  EXPECT_EQ(first_restarted(scenario, nothing), EntityId{1U}) << "0 restarts by itself when he is called";
  scenario.faults = {fault(Fault::Kind::Restart, 35.0, 10.0)};
  EXPECT_EQ(first_restarted(scenario, nothing), EntityId{1U}) << "and here when he comes: he is called anew";
  scenario.faults.clear();
  scenario.agvs[0].battery = 0.1;
  EXPECT_EQ(first_restarted(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 0 && e.kind == FP_EVENT_START) host.charge(c, FP_HERE);
  }), EntityId{1U});
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
    Told told;
    const Helped seen = run(scenario, bring_the_load(told));
    const SimTime contact = seen.trace.of(TraceKind::Contact).at(0).at, both_back = seen.trace.of(TraceKind::Appears).at(1).at;
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
}  // namespace fleetproof
