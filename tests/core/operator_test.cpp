// What the operator does after a contact, one thing at a time.
#include "tests/core/helped.hpp"

namespace fleetproof::operator_test {
namespace {

using test::bring_the_load;
using test::comes_after;
using test::fault;
using test::Heard;
using test::Helped;
using test::kBattery;
using test::kContact;
using test::row_of_tens;
using test::run;
using test::somebody_in_the_way;

TEST(AfterAContact, TheAgvIsSetDownAtTheEndOfItsSegmentAndDelivers) {
  Scenario scenario = somebody_in_the_way();
  scenario.operator_help = comes_after(20.0);
  Heard heard;
  const Helped seen = run(scenario, bring_the_load(heard));
  EXPECT_EQ(seen.outcome.counters.contacts, 1U);
  EXPECT_TRUE(seen.outcome.contact) << "help undoes nothing";
  EXPECT_EQ(seen.outcome.counters.assists, 2U);
  const auto assists = seen.assists(kContact);
  ASSERT_EQ(assists.size(), 2U);
  EXPECT_NEAR(to_seconds(assists[0].at - seen.trace.of(TraceKind::Contact).at(0).at), 20.0, 1e-8);
  EXPECT_EQ(seen.trace.of(TraceKind::Leaves).size(), 2U);
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 1U);
  EXPECT_NEAR(seen.set_down_s(EntityId{0U}), 21.0, 1e-8);
  EXPECT_EQ(heard.boots, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(heard.stations, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(heard.segments, (std::vector<std::uint32_t>{FP_NONE, FP_NONE}));
  EXPECT_EQ(heard.loaded, (std::vector<std::uint32_t>{0, 1})) << "it keeps its load";
  EXPECT_EQ(heard.actions.at(1), static_cast<std::uint32_t>(FP_IDLE));
  EXPECT_EQ(heard.orders, 2) << "told again";
  EXPECT_EQ(seen.outcome.counters.transports_done, 1U);
  EXPECT_FALSE(seen.outcome.stuck);
}

TEST(AfterAContact, WhoseStationIsTakenComesToTheNearestThatIsFree) {
  Scenario scenario = somebody_in_the_way();
  scenario.operator_help = comes_after(20.0);
  Heard heard;
  const Helped seen = run(scenario, bring_the_load(heard));
  EXPECT_EQ(seen.set_down_at(EntityId{1U}), 0U)
      << "AGV 0 stands at station 1 by then; 0 and 2 are as near, and 0 is the first";
}

TEST(AfterAContact, WithoutTheOperatorItStandsForGood) {
  Heard heard;
  const Helped seen = run(somebody_in_the_way(), bring_the_load(heard));
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
  const Helped seen =
      run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
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
  scenario.obstacles.push_back(
      {"ahead", {0.5, 0.5}, {Vec2{11.14, 0.0}, Vec2::UnitX()}, Duration{}, seconds(50.5)});  // 9 cm from its front
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
  scenario.obstacles.push_back(
      {"wall", {2.0, 0.02}, {Vec2{11.012, 0.712}, Vec2{1.0, -1.0}.normalized()}});  // 0.29 m from its front left corner
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
    if (b.self != 0) return;
    if (e.kind == FP_EVENT_START && b.boot == 0) host.move(c, 0);
    if (e.kind == FP_EVENT_START && b.boot == 1) host.set_timer(c, 1, 60'000'000'000);
    if (e.kind == FP_EVENT_TIMER) host.move(c, 0);
  });
  EXPECT_EQ(seen.outcome.counters.contacts, 2U) << "0 at station 1 drives back to station 0, where 1 stands by then";
  EXPECT_EQ(seen.assists(kContact).size(), 4U);
}

TEST(AfterAContact, NobodyIsSetDownOnALaneThatWillBeDriven) {
  Scenario scenario = row_of_tens({0, 1}, 100.0);
  scenario.operator_help = comes_after(20.0);
  const Helped seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (e.kind == FP_EVENT_START && b.self == 0 && b.boot < 2) host.move(c, 0);
  });
  EXPECT_EQ(seen.outcome.counters.contacts, 1U)
      << "0, which has to turn first, drives back from station 1 to station 0";
}

TEST(AfterAContact, WhatHeldTheAgvHoldsItNoLonger) {
  Scenario scenario = row_of_tens({1, 0}, 200.0);
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 1.0, 150.0)};
  scenario.operator_help = comes_after(20.0);
  std::vector<double> done_s;
  const Helped seen =
      run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
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
  ASSERT_EQ(seen.trace.of(TraceKind::FaultOver).size(), 1U);
  EXPECT_EQ(seen.trace.of(TraceKind::FaultOver)[0].at, seen.assists(kContact)[0].at)
      << "the stop, which would have lasted on";
}

TEST(AfterAContact, WhatItWasAboutToDoIsForgotten) {
  Scenario scenario = row_of_tens({1, 0}, 200.0);
  scenario.faults = {fault(Fault::Kind::ProtectiveStop, 1.0, 150.0), fault(Fault::Kind::ProtectiveStop, 60.0, 5.0)};
  scenario.operator_help = comes_after(20.0);
  int done = 0;
  const Helped seen =
      run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
        if (e.kind == FP_EVENT_START && b.self == 1 && b.boot == 0) host.move(c, 0);
        if (b.self == 0 && e.kind == FP_EVENT_START && b.boot == 0) host.set_timer(c, 1, 2'000'000'000);
        if (b.self == 0 && e.kind == FP_EVENT_TIMER)
          host.move(c, 1);  // waits for the end of the stop, and is hit meanwhile
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
  const Helped seen =
      run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
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
  scenario.obstacles = {
      {"box",
       {0.5, 0.5},
       {Vec2{11.17, 0.0},
        Vec2::UnitX()}}};  // 12 cm before the AGV at station 1: in its field, and no nearer than it may be
  scenario.scanner.on = true;
  scenario.operator_help = comes_after(10.0);
  const Helped seen = run(scenario, [](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
    if (b.self == 0 && e.kind == FP_EVENT_START) host.move(c, b.boot);
  });
  const auto contacts = seen.trace.of(TraceKind::Contact);
  ASSERT_FALSE(contacts.empty()) << "sent on, it drives into AGV 1";
  const double set_down_s = seen.set_down_s(EntityId{0U});
  EXPECT_GT(set_down_s, 0.0);
  for (std::size_t i = 1; i < contacts.size(); ++i)
    EXPECT_GT(to_seconds(contacts[i].at - contacts[0].at), set_down_s + 9.0) << "before anybody mutes it again";
}

TEST(AfterAContact, AnEmptyBatteryIsChangedOnTheOccasion) {
  Scenario scenario = somebody_in_the_way();
  scenario.vehicle_types[0].battery_idle_per_s = 0.01;
  scenario.agvs[0].battery = 0.2;
  scenario.operator_help = comes_after(30.0);
  Heard heard;
  const Helped seen = run(scenario, bring_the_load(heard));
  const auto changed = seen.assists(kBattery);
  ASSERT_GE(changed.size(), 1U);
  EXPECT_EQ(changed[0].entity, EntityId{0U});
  EXPECT_NEAR(to_seconds(changed[0].at - seen.trace.of(TraceKind::Contact).at(0).at), 31.0, 1e-8)
      << "where it is set down";
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
    Heard heard;
    const Helped seen = run(scenario, bring_the_load(heard));
    const double set_down_s = to_seconds(seen.trace.of(TraceKind::Contact).at(0).at) + seen.set_down_s(EntityId{0U});
    EXPECT_GT(set_down_s, 31.7);
    EXPECT_LT(set_down_s - 1.0, 31.7);
    EXPECT_EQ(heard.boots, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_NEAR(heard.at_s.at(1), std::max(set_down_s, 10.0 + lasts_s), 1e-8);
    EXPECT_EQ(seen.outcome.counters.transports_done, 1U);
  }
}

TEST(AfterAContact, ACrashedAgentStaysCrashed) {
  Scenario scenario = row_of_tens({0, 1}, 100.0);
  scenario.operator_help = comes_after(20.0);
  int starts = 0;
  const Helped seen =
      run(scenario, [&](const fp_host& host, fp_controller* c, const fp_briefing& b, const fp_event& e) {
        if (b.self != 0 || e.kind != FP_EVENT_START) return;
        ++starts;
        host.move(c, 0);
        throw std::runtime_error("on its way");
      });
  EXPECT_EQ(starts, 1);
  EXPECT_TRUE(seen.outcome.crash);
  EXPECT_EQ(seen.set_down_at(EntityId{0U}), 1U);
}

}  // namespace
}  // namespace fleetproof::operator_test
