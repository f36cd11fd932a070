#include "core/engine/agv_controller.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::agv_controller_test {
namespace {

using test::kFirst;
using test::kSecond;
using test::SmallWorld;
using test::started;

Scenario with_call_cost(double cost_s) {
  Scenario scenario = test::row_of_tens({0, 2});
  scenario.agent_clock.call_cost_s = cost_s;
  return scenario;
}

TEST(AgvControllerPart, AdmitsCallsInAnActivationOnly) {
  SmallWorld world(with_call_cost(0.0));
  auto& controller = world.parts.controller;
  EXPECT_FALSE(controller.admit(*world.parts.controller.handle_of(kFirst)));
  controller.begin_activation(*world.parts.controller.handle_of(kFirst));
  EXPECT_TRUE(controller.admit(*world.parts.controller.handle_of(kFirst)));
  EXPECT_FALSE(controller.admit(*world.parts.controller.handle_of(kSecond))) << "the other one's agent is not awake";
  EXPECT_FALSE(controller.end_activation(*world.parts.controller.handle_of(kFirst))) << "nothing to settle";
  EXPECT_FALSE(controller.admit(*world.parts.controller.handle_of(kFirst)));
}

TEST(AgvControllerPart, ACallTakesEffectAfterTheCostsSoFar) {
  SmallWorld world(with_call_cost(0.1));
  started(world);
  auto& controller = world.parts.controller;
  controller.begin_activation(*world.parts.controller.handle_of(kFirst));
  ASSERT_TRUE(controller.admit(*world.parts.controller.handle_of(kFirst)));
  EXPECT_EQ(controller.declare_cost(kFirst, 900'000'000), FP_OK);
  EXPECT_EQ(controller.declare_cost(kFirst, -1), FP_INVALID);
  ASSERT_TRUE(controller.admit(*world.parts.controller.handle_of(kFirst)));
  EXPECT_EQ(controller.act(kFirst, FP_CALL_MOVE, 0), FP_OK);
  EXPECT_TRUE(controller.end_activation(*world.parts.controller.handle_of(kFirst)));
  EXPECT_DOUBLE_EQ(to_seconds(controller.handle_of(kFirst)->cost), 1.1);
  EXPECT_EQ(controller.handle_of(kFirst)->broken_limit(), nullptr);
  EXPECT_FALSE(world.run.status(kFirst).activity);
  EXPECT_DOUBLE_EQ(to_seconds(world.next(Event::Kind::CallTakesEffect).at), 1.1);
  controller.call_takes_effect(kFirst);
  EXPECT_TRUE(world.run.status(kFirst).is_driving());
}

TEST(AgvControllerPart, WithoutCostsACallTakesEffectAtOnce) {
  SmallWorld world(with_call_cost(0.0));
  started(world);
  world.parts.controller.begin_activation(*world.parts.controller.handle_of(kFirst));
  EXPECT_EQ(world.parts.controller.act(kFirst, FP_CALL_MOVE, 77), FP_INVALID);
  EXPECT_EQ(world.parts.controller.act(kFirst, FP_CALL_MOVE, 0), FP_OK);
  EXPECT_TRUE(world.run.status(kFirst).is_driving());
}

TEST(AgvControllerPart, WhatIsPendingIsLostWithTheComputer) {
  SmallWorld world(with_call_cost(0.1));
  started(world);
  auto& controller = world.parts.controller;
  controller.begin_activation(*world.parts.controller.handle_of(kFirst));
  ASSERT_TRUE(controller.admit(*world.parts.controller.handle_of(kFirst)));
  EXPECT_EQ(controller.act(kFirst, FP_CALL_MOVE, 0), FP_OK);
  EXPECT_EQ(controller.send(kFirst, "hello", kSecond.value), FP_OK);
  controller.end_activation(*world.parts.controller.handle_of(kFirst));
  controller.forget(kFirst);
  controller.call_takes_effect(kFirst);
  controller.call_takes_effect(kFirst);
  EXPECT_FALSE(world.run.status(kFirst).activity);
  EXPECT_EQ(world.run.counters.messages_sent, 0U);
  EXPECT_TRUE(world.parts.actions.accept(kFirst, FP_CALL_MOVE, 0)) << "the AGV is free again";
}

TEST(AgvControllerPart, TimeInSafeModeIsCountedToTheEndOfTheRun) {
  SmallWorld world(with_call_cost(0.0));
  world.clock(1.0);
  world.parts.controller.declare_safe_mode(kFirst, true);
  world.clock(3.0);
  world.parts.controller.declare_safe_mode(kFirst, true);
  world.clock(4.0);
  world.parts.controller.declare_safe_mode(kFirst, false);
  world.parts.controller.declare_safe_mode(kSecond, true);
  world.clock(10.0);
  world.parts.declarations.settle_accounts();
  EXPECT_EQ(world.run.counters.safe_mode_ns, 9'000'000'000U);
}

}  // namespace
}  // namespace fleetproof::agv_controller_test
