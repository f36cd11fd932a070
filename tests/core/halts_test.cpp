#include "core/engine/halts.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::halts_test {
namespace {

using test::kFirst;
using test::SmallWorld;

// The AGV is under way over segment 0, 4 s after its start.
void under_way(SmallWorld& world) {
  ASSERT_TRUE(world.parts.actions.accept(kFirst, FP_CALL_MOVE, 0));
  world.parts.actions.begin(kFirst, FP_CALL_MOVE, 0);
  world.clock(4.0);
}

double planned_end_s(const SmallWorld& world) { return to_seconds(world.run.agvs[0].activity->end); }

TEST(HaltsPart, TheFirstBrakesAndTheLastLetsGoOn) {
  SmallWorld world(test::row_of_tens({0}));
  under_way(world);
  const std::uint64_t one = world.parts.halts.begin(kFirst, Halt::Reason::ProtectiveStop);
  EXPECT_NEAR(planned_end_s(world), 6.0, 1e-9) << "it brakes";
  const std::uint64_t two = world.parts.halts.begin(kFirst, Halt::Reason::Breakdown);
  EXPECT_NE(one, two);
  world.parts.halts.end(kFirst, one);
  EXPECT_NEAR(planned_end_s(world), 6.0, 1e-9) << "the other still holds it";
  world.parts.halts.end(kFirst, one);
  EXPECT_EQ(world.run.status(kFirst).halts.size(), 1U) << "a halt ends once";
  world.parts.halts.end(kFirst, two);
  EXPECT_NEAR(planned_end_s(world), 8.0, 1e-9) << "no time has passed: as if nothing had been";
}

TEST(HaltsPart, AnAgvMakesProgressWhenTheLastHaltEnds) {
  SmallWorld world(test::row_of_tens({0}));
  const std::uint64_t one = world.parts.halts.begin(kFirst, Halt::Reason::ProtectiveStop);
  const std::uint64_t two = world.parts.halts.begin(kFirst, Halt::Reason::Breakdown);
  world.clock(3.0);
  world.parts.halts.end(kFirst, one);
  EXPECT_EQ(world.run.status(kFirst).last_progress, kStart) << "the other still holds it";
  world.parts.halts.end(kFirst, two);
  EXPECT_EQ(world.run.status(kFirst).last_progress, at_seconds(3.0));
}

TEST(HaltsPart, WhatTheAgentDoesToItsAgvIsNoProgress) {
  SmallWorld world(test::row_of_tens({0}));
  const std::uint64_t own = world.parts.halts.begin(kFirst, Halt::Reason::Agent);
  world.clock(3.0);
  world.parts.halts.end(kFirst, own);
  EXPECT_EQ(world.run.status(kFirst).last_progress, kStart);
}

TEST(HaltsPart, AllOfOneReasonEndTogetherAndOthersStay) {
  SmallWorld world(test::row_of_tens({0}));
  for (const auto reason : {Halt::Reason::Scanner, Halt::Reason::Breakdown, Halt::Reason::Scanner})
    world.parts.halts.begin(kFirst, reason);
  world.parts.halts.end_all(kFirst, Halt::Reason::Scanner);
  ASSERT_EQ(world.run.status(kFirst).halts.size(), 1U);
  EXPECT_TRUE(world.run.status(kFirst).is_held_by(Halt::Reason::Breakdown));
}

TEST(HaltsPart, TheEndOfAHaltMovesNoAgvThatIsOutOfOrder) {
  SmallWorld world(test::row_of_tens({0}));
  started(world);  // its agent hears that the action was cut short
  under_way(world);
  const std::uint64_t number = world.parts.halts.begin(kFirst, Halt::Reason::ProtectiveStop);
  world.parts.actions.stop_for_good(kFirst);
  world.parts.halts.end(kFirst, number);
  EXPECT_TRUE(world.run.status(kFirst).halts.empty());
  EXPECT_FALSE(world.run.status(kFirst).activity);
}

}  // namespace
}  // namespace fleetproof::halts_test
