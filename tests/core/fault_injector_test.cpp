#include "core/engine/fault_injector.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::fault_injector_test {
namespace {

using test::fault;
using test::kFirst;
using test::SmallWorld;
using test::started;

Scenario with(std::vector<Fault> faults) {
  Scenario scenario = test::row_of_tens({0});
  scenario.agvs[0].transports.assign(2, {StationId{0U}, StationId{2U}, Duration{}});
  scenario.faults = std::move(faults);
  return scenario;
}

TEST(FaultInjectorPart, ABreakdownHoldsTheAgvWhileItLasts) {
  SmallWorld world(with({fault(Fault::Kind::Breakdown, 3.0, 20.0)}));
  world.parts.faults.schedule();
  const Event strike = world.next(Event::Kind::FaultStrikes);
  EXPECT_DOUBLE_EQ(to_seconds(strike.at), 3.0);
  world.parts.faults.strikes(kFirst, strike.payload);
  EXPECT_TRUE(world.run.status(kFirst).is_held_by(Halt::Reason::Breakdown));
  const Event over = world.next(Event::Kind::FaultOver);
  EXPECT_DOUBLE_EQ(to_seconds(over.at), 23.0);
  world.parts.faults.ends(kFirst, over.payload);
  EXPECT_TRUE(world.run.status(kFirst).halts.empty());
  EXPECT_EQ(world.run.counters.faults, 1U);
  EXPECT_EQ(world.trace.of(TraceKind::FaultOver).size(), 1U);
}

TEST(FaultInjectorPart, WhatTheOperatorEndsEarlyIsNotOverTwice) {
  SmallWorld world(with({fault(Fault::Kind::ProtectiveStop, 0.0, 20.0)}));
  world.parts.faults.strikes(kFirst, 0);
  world.parts.faults.end_halts_of(kFirst);
  EXPECT_TRUE(world.run.status(kFirst).halts.empty());
  world.parts.faults.ends(kFirst, 0);
  EXPECT_EQ(world.trace.of(TraceKind::FaultOver).size(), 1U);
}

TEST(FaultInjectorPart, AFaultCountedFromAPickIsSetByTheFirstPickOnly) {
  Fault after_pick = fault(Fault::Kind::Breakdown, 2.0, 1.0);
  after_pick.transport = 1;
  SmallWorld world(with({after_pick}));
  world.parts.faults.schedule();
  world.clock(10.0);
  world.parts.faults.load_taken_up(kFirst, TransportId{0U});
  EXPECT_TRUE(world.run.queue.empty()) << "another transport's load";
  world.parts.faults.load_taken_up(kFirst, TransportId{1U});
  EXPECT_DOUBLE_EQ(to_seconds(world.next(Event::Kind::FaultStrikes).at), 12.0);
  world.parts.faults.load_taken_up(kFirst, TransportId{1U});
  EXPECT_TRUE(world.run.queue.empty()) << "the second time that it is taken up";
}

TEST(FaultInjectorPart, ARestartTakesTheAgentAwayAndBringsItBack) {
  SmallWorld world(with({fault(Fault::Kind::Restart, 0.0, 5.0)}));
  started(world);
  world.parts.faults.strikes(kFirst, 0);
  EXPECT_FALSE(world.parts.agents.is_up(kFirst));
  world.parts.faults.strikes(kFirst, 0);
  EXPECT_EQ(world.run.counters.faults, 1U) << "what is down cannot fail";
  world.parts.faults.ends(kFirst, 0);
  EXPECT_TRUE(world.parts.agents.is_up(kFirst));
}

TEST(FaultInjectorPart, APowerFailureHoldsTheAgvAndTakesItsComputerAway) {
  SmallWorld world(with({fault(Fault::Kind::PowerFailure, 0.0, 30.0)}));
  started(world).heard.clear();
  world.parts.faults.strikes(kFirst, 0);
  EXPECT_TRUE(world.run.status(kFirst).is_held_by(Halt::Reason::Breakdown));
  EXPECT_FALSE(world.parts.agents.is_up(kFirst));
  const Event over = world.next(Event::Kind::FaultOver);
  EXPECT_DOUBLE_EQ(to_seconds(over.at), 30.0);
  world.parts.faults.ends(kFirst, over.payload);
  EXPECT_TRUE(world.run.status(kFirst).halts.empty());
  EXPECT_TRUE(world.parts.agents.is_up(kFirst));
  ASSERT_EQ(world.heard.size(), 1U);
  EXPECT_EQ(world.heard[0].kind, FP_EVENT_START);
  EXPECT_EQ(world.trace.of(TraceKind::FaultOver).size(), 1U);
}

// The operator ends the halt early: the computer still needs its time.
TEST(FaultInjectorPart, PowerComesBackAtItsTimeWhoeverMovesTheAgv) {
  SmallWorld world(with({fault(Fault::Kind::PowerFailure, 0.0, 30.0)}));
  started(world);
  world.parts.faults.strikes(kFirst, 0);
  world.parts.faults.end_halts_of(kFirst);
  EXPECT_FALSE(world.parts.agents.is_up(kFirst));
  world.parts.faults.ends(kFirst, 0);
  EXPECT_TRUE(world.parts.agents.is_up(kFirst));
  EXPECT_EQ(world.trace.of(TraceKind::FaultOver).size(), 1U);
}

TEST(FaultInjectorPart, AnObstacleWaitsUntilItsPlaceIsFree) {
  Scenario scenario = test::row_of_tens({0});
  scenario.obstacles.push_back({"crate", {1.0, 1.0}, {Vec2{0.5, 0.0}, Vec2::UnitX()}, seconds(1.0)});
  SmallWorld world(scenario);
  const EntityId crate{1U};
  world.clock(1.0);
  world.parts.faults.obstacle_appears(crate);
  EXPECT_FALSE(world.run.world.body(crate).on_floor) << "the AGV stands there";
  EXPECT_DOUBLE_EQ(to_seconds(world.next(Event::Kind::BodyAppears).at), 2.0);
  world.run.world.take_off_floor(kFirst, world.run.now);
  world.parts.faults.obstacle_appears(crate);
  EXPECT_TRUE(world.run.world.body(crate).on_floor);
  world.parts.faults.body_leaves(crate);
  EXPECT_FALSE(world.run.world.body(crate).on_floor);
}

std::vector<Denial> denials(const SmallWorld& world) {
  std::vector<Denial> whys;
  for (const TraceRecord& record : world.trace.of(TraceKind::Denied)) whys.push_back(read<traced::Denied>(record).why);
  return whys;
}

TEST(FaultInjectorPart, AnObstacleIsDeniedOnceHoweverLongItWaits) {
  Scenario scenario = test::row_of_tens({0});
  scenario.obstacles.push_back({"crate", {1.0, 1.0}, {Vec2{0.5, 0.0}, Vec2::UnitX()}, seconds(1.0), seconds(4.0)});
  SmallWorld world(scenario);
  for (const double at_s : {1.0, 2.0, 3.0}) {
    world.clock(at_s);
    world.parts.faults.obstacle_appears(EntityId{1U});
  }
  EXPECT_EQ(denials(world), std::vector<Denial>{Denial::NoRoom});
}

TEST(FaultInjectorPart, ALoadIsDeniedWithItsReason) {
  Fault too_near = fault(Fault::Kind::LoadDrop, 0.0, 30.0);
  too_near.ahead_m = -1.0;
  Fault of_another = fault(Fault::Kind::LoadDrop, 0.0, 30.0);
  of_another.transport = 1;
  SmallWorld world(with({too_near, of_another}));
  world.parts.faults.strikes(kFirst, 0);
  const LoadId load = world.run.world.add_load(TransportId{0U}, kFirst, StationId{0U}, StationId{2U});
  world.run.world.move_load(load, {Holder::Kind::Agv, kFirst.value});
  world.parts.faults.strikes(kFirst, 0);
  world.parts.faults.strikes(kFirst, 1);
  EXPECT_EQ(denials(world), (std::vector<Denial>{Denial::NoSuchLoad, Denial::NoRoom, Denial::NoSuchLoad}));
  EXPECT_EQ(world.run.counters.faults, 0U);
}

TEST(FaultInjectorPart, AFaultOfWhatIsOutOfOrderIsDenied) {
  SmallWorld world(with({fault(Fault::Kind::Restart, 0.0, 5.0), fault(Fault::Kind::Breakdown, 0.0, 5.0)}));
  started(world);
  world.parts.faults.strikes(kFirst, 0);
  world.parts.faults.strikes(kFirst, 0);
  world.run.status(kFirst).out_of_order = true;
  world.parts.faults.strikes(kFirst, 1);
  EXPECT_EQ(denials(world), (std::vector<Denial>{Denial::AgentAway, Denial::OutOfOrder}));
}

TEST(FaultInjectorPart, AFallenLoadLiesOnTheFloorUntilItIsClearedAway) {
  SmallWorld world(with({fault(Fault::Kind::LoadDrop, 0.0, 30.0)}));
  world.parts.faults.strikes(kFirst, 0);
  EXPECT_EQ(world.run.counters.faults, 0U) << "an empty AGV loses nothing";
  const LoadId load = world.run.world.add_load(TransportId{0U}, kFirst, StationId{0U}, StationId{2U});
  world.run.world.move_load(load, {Holder::Kind::Agv, kFirst.value});
  world.parts.faults.strikes(kFirst, 0);
  const EntityId body{1U};
  EXPECT_TRUE(world.run.world.body(body).on_floor);
  EXPECT_EQ(world.run.world.load(load).holder, (Holder{Holder::Kind::Floor, body.value}));
  world.parts.faults.body_leaves(body);
  EXPECT_TRUE(world.run.world.load(load).is_over());
  EXPECT_EQ(world.run.counters.loads_cleared, 1U);
}

}  // namespace
}  // namespace fleetproof::fault_injector_test
