#include "core/engine/actions.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::actions_test {
namespace {

using test::kFirst;
using test::SmallWorld;
using test::started;

bool order(SmallWorld& world, fp_call call, std::uint32_t segment) {
  if (!world.parts.actions.accept(kFirst, call, segment)) return false;
  world.parts.actions.begin(kFirst, call, segment);
  return true;
}

// Ends the activity under way at its planned end.
void end_activity(SmallWorld& world) {
  world.run.now = world.run.status(kFirst).activity->end;
  world.parts.actions.activity_ends(kFirst);
}

ActivityKind under_way(const SmallWorld& world) { return world.run.agvs[0].activity->kind; }

int done(const SmallWorld& world, std::int32_t result) {
  return static_cast<int>(std::ranges::count_if(world.heard, [&](const fp_event& event) {
    return event.kind == FP_EVENT_ACTION_DONE && event.result == result;
  }));
}

TEST(ActionsPart, TurnsThenDrivesThenStays) {
  Scenario scenario = test::row_of_tens({1});
  SmallWorld world(scenario);
  started(world);
  ASSERT_TRUE(order(world, FP_CALL_PARK, 0)) << "behind it: the AGV looks along x";
  EXPECT_EQ(under_way(world), ActivityKind::Turn);
  EXPECT_EQ(world.parts.actions.doing(kFirst), FP_TURNING);
  end_activity(world);
  EXPECT_EQ(under_way(world), ActivityKind::Drive);
  end_activity(world);
  EXPECT_EQ(world.run.status(kFirst).station, StationId{0U});
  EXPECT_EQ(under_way(world), ActivityKind::Park);
  EXPECT_EQ(done(world, FP_OK), 0);
  end_activity(world);
  EXPECT_EQ(done(world, FP_OK), 1);
  EXPECT_EQ(world.parts.actions.doing(kFirst), FP_PARKED);
}

TEST(ActionsPart, TakesOneCallAndBehindAMoveOneMore) {
  SmallWorld world(test::row_of_tens({0}));
  started(world);
  EXPECT_FALSE(order(world, FP_CALL_MOVE, 2)) << "does not leave station 0";
  ASSERT_TRUE(world.parts.actions.accept(kFirst, FP_CALL_MOVE, 0));
  EXPECT_FALSE(world.parts.actions.accept(kFirst, FP_CALL_MOVE, 1)) << "the first has not taken effect";
  world.parts.actions.begin(kFirst, FP_CALL_MOVE, 0);
  EXPECT_FALSE(order(world, FP_CALL_PICK, FP_HERE)) << "it is on its way";
  EXPECT_TRUE(order(world, FP_CALL_MOVE, 1));
  EXPECT_FALSE(order(world, FP_CALL_MOVE, 2)) << "one only";
  EXPECT_EQ(world.run.counters.refused_calls, 4U);
  const LanesAhead lanes = world.parts.actions.lanes(kFirst);
  EXPECT_EQ(lanes.current, &world.lane(0, 0));
  EXPECT_EQ(lanes.next, &world.lane(1, 1));
  EXPECT_TRUE(lanes.still_to_drive);
  end_activity(world);
  EXPECT_EQ(world.run.counters.rolls, 1U);
  EXPECT_EQ(done(world, FP_OK), 1);
  EXPECT_EQ(world.parts.actions.lanes(kFirst).current, &world.lane(1, 1));
}

TEST(ActionsPart, AnAcceptedCallCanBeWithdrawn) {
  SmallWorld world(test::row_of_tens({0}));
  ASSERT_TRUE(world.parts.actions.accept(kFirst, FP_CALL_MOVE, 0));
  world.parts.actions.withdraw_accepted(kFirst);
  EXPECT_TRUE(world.parts.actions.accept(kFirst, FP_CALL_MOVE, 0));
}

TEST(ActionsPart, ATransferThatIsHaltedBeginsAgain) {
  SmallWorld world(test::row_of_tens({0}));
  started(world);
  ASSERT_TRUE(order(world, FP_CALL_PICK, FP_HERE));
  world.clock(3.0);
  const std::uint64_t halt = world.parts.halts.begin(kFirst, Halt::Reason::ProtectiveStop);
  EXPECT_FALSE(world.run.status(kFirst).activity);
  EXPECT_EQ(world.parts.actions.doing(kFirst), FP_STOPPED);
  world.clock(10.0);
  world.parts.halts.end(kFirst, halt);
  EXPECT_EQ(under_way(world), ActivityKind::Pick);
  EXPECT_DOUBLE_EQ(to_seconds(world.run.status(kFirst).activity->end), 15.0);
}

// Connecting takes 10 s; a halt in the middle of it makes the AGV connect anew.
TEST(ActionsPart, DocksBeforeItCharges) {
  Scenario scenario = test::row_of_tens({0});
  scenario.vehicle_types[0].dock_s = 10.0;
  scenario.agvs[0].battery = 0.5;
  SmallWorld world(scenario);
  started(world);
  ASSERT_TRUE(order(world, FP_CALL_CHARGE, FP_HERE));
  EXPECT_EQ(under_way(world), ActivityKind::Dock);
  world.clock(4.0);
  const std::uint64_t halt = world.parts.halts.begin(kFirst, Halt::Reason::ProtectiveStop);
  EXPECT_FALSE(world.run.status(kFirst).activity);
  world.clock(6.0);
  world.parts.halts.end(kFirst, halt);
  EXPECT_EQ(under_way(world), ActivityKind::Dock);
  EXPECT_EQ(done(world, FP_OK), 0);
  end_activity(world);
  EXPECT_DOUBLE_EQ(to_seconds(world.run.now), 16.0);
  EXPECT_EQ(under_way(world), ActivityKind::Charge);
  EXPECT_EQ(done(world, FP_OK), 1) << "connected";
  EXPECT_DOUBLE_EQ(world.parts.battery.level(kFirst), 0.5) << "docking charges nothing";
}

TEST(ActionsPart, WithoutADockingTimeItChargesAtOnce) {
  SmallWorld world(test::row_of_tens({0}));
  started(world);
  ASSERT_TRUE(order(world, FP_CALL_CHARGE, FP_HERE));
  EXPECT_EQ(under_way(world), ActivityKind::Charge);
}

TEST(ActionsPart, StoppedForGoodItAnswersForEveryActionAndObeysAgainWhenPutBack) {
  SmallWorld world(test::row_of_tens({0}));
  started(world);
  ASSERT_TRUE(order(world, FP_CALL_MOVE, 0) && order(world, FP_CALL_MOVE, 1));
  world.clock(4.0);
  EXPECT_TRUE(world.parts.actions.stop_for_good(kFirst));
  EXPECT_FALSE(world.parts.actions.stop_for_good(kFirst)) << "once";
  EXPECT_EQ(done(world, FP_REFUSED), 2);
  EXPECT_EQ(world.run.status(kFirst).stopped_on, &world.lane(0, 0));
  EXPECT_EQ(world.parts.actions.doing(kFirst), FP_OUT_OF_ORDER);
  EXPECT_FALSE(order(world, FP_CALL_MOVE, 0));
  world.parts.actions.put_back(kFirst, StationId{1U});
  EXPECT_EQ(world.parts.actions.doing(kFirst), FP_IDLE);
  EXPECT_TRUE(world.parts.actions.accept(kFirst, FP_CALL_MOVE, 1));
}

}  // namespace
}  // namespace fleetproof::actions_test
