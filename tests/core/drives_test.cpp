#include "core/engine/drives.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof {
namespace {

using test::kFirst;
using test::SmallWorld;

void begin(SmallWorld& world, const Lane* next = nullptr) {
  world.parts.drives.begin(kFirst, world.lane(0, 0), 0.0, 0.0, next);
}

double planned_end_s(const SmallWorld& world) { return to_seconds(world.run.agvs[0].activity->end); }

TEST(DrivesPart, WithoutANextLaneTheAgvStopsAtTheStation) {
  SmallWorld world(test::row_of_tens({0}));
  begin(world);
  EXPECT_NEAR(planned_end_s(world), 8.0, 1e-9);
  world.clock(8.0);
  const LegEnd end = world.parts.drives.leg_ends(kFirst);
  EXPECT_EQ(end.kind, LegEnd::Kind::Arrived);
  EXPECT_EQ(end.speed_mps, 0.0);
  EXPECT_EQ(world.run.counters.drives, 1U);
}

TEST(DrivesPart, StraightOnItRollsThroughAndBackItDoesNot) {
  SmallWorld on(test::row_of_tens({0})), back(test::row_of_tens({0}));
  begin(on, &on.lane(1, 1));
  EXPECT_NEAR(planned_end_s(on), 7.0, 1e-9) << "4 s to 2 m/s over 4 m, then 6 m";
  on.clock(7.0);
  EXPECT_NEAR(on.parts.drives.leg_ends(kFirst).speed_mps, 2.0, 1e-9);
  begin(back, &back.lane(0, 1));
  EXPECT_NEAR(planned_end_s(back), 8.0, 1e-9);
}

TEST(DrivesPart, ANextLaneIsTakenIntoAccountUntilTheAgvBrakes) {
  SmallWorld early(test::row_of_tens({0})), late(test::row_of_tens({0}));
  begin(early);
  early.clock(5.9);
  early.parts.drives.release_next(kFirst, early.lane(1, 1));
  EXPECT_NEAR(planned_end_s(early), 7.0, 1e-9);
  begin(late);
  late.clock(6.1);
  late.parts.drives.release_next(kFirst, late.lane(1, 1));
  EXPECT_NEAR(planned_end_s(late), 8.0, 1e-9);
}

TEST(DrivesPart, AHaltBringsItToAStopOnTheWay) {
  SmallWorld world(test::row_of_tens({0}));
  begin(world);
  world.clock(4.0);
  world.run.status(kFirst).halts.push_back({Halt::Reason::ProtectiveStop, 1});
  world.parts.drives.replan(kFirst);
  EXPECT_NEAR(planned_end_s(world), 6.0, 1e-9) << "2 s from 2 m/s at 1 m/s2";
  world.clock(6.0);
  const LegEnd end = world.parts.drives.leg_ends(kFirst);
  EXPECT_EQ(end.kind, LegEnd::Kind::Halted);
  EXPECT_NEAR(end.way_m, 6.0, 1e-9);
}

TEST(DrivesPart, EachDriveHasADeviationOfItsOwn) {
  Scenario scenario = test::row_of_tens({0});
  scenario.vehicle_types[0].speed_deviation = 0.1;
  SmallWorld world(scenario);
  begin(world);
  const double first_s = planned_end_s(world);
  begin(world);
  EXPECT_NE(planned_end_s(world), first_s);
  EXPECT_NEAR(first_s, 8.0, 0.9);
  EXPECT_EQ(world.parts.drives.begun(kFirst), 2U);
}

}  // namespace
}  // namespace fleetproof
