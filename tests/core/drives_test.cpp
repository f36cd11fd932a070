#include "core/engine/drives.hpp"

#include "tests/core/small_world.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::drives_test {
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

// The row with limits on its first two segments.
Scenario limited_row(double first_mps, double back_mps, double second_mps) {
  Scenario scenario = test::row_of_tens({0});
  Layout layout = scenario.map->layout();
  layout.segments[0].speed_limit_mps = first_mps;
  layout.segments[0].back_speed_limit_mps = back_mps;
  layout.segments[1].speed_limit_mps = second_mps;
  scenario.map = std::make_shared<const LogicalMap>(layout);
  return scenario;
}

TEST(DrivesPart, KeepTheSpeedLimitOfTheirDirection) {
  SmallWorld limited(limited_row(1.0, 0.0, 0.0)), faster(limited_row(5.0, 1.0, 0.0));
  begin(limited);
  EXPECT_NEAR(planned_end_s(limited), 11.5, 1e-9) << "2 s to 1 m/s over 1 m, 8.5 m, 1 s over 0.5 m";
  begin(faster);
  EXPECT_NEAR(planned_end_s(faster), 8.0, 1e-9) << "a limit above the vehicle's speed, and one of the other direction";
}

TEST(DrivesPart, ReachASlowerLaneAtItsLimitAndLeaveASlowLaneAtTheirs) {
  SmallWorld into_slow(limited_row(0.0, 0.0, 1.0)), out_of_slow(limited_row(1.0, 0.0, 0.0));
  begin(into_slow, &into_slow.lane(1, 1));
  into_slow.clock(planned_end_s(into_slow));
  EXPECT_NEAR(into_slow.parts.drives.leg_ends(kFirst).speed_mps, 1.0, 1e-9);
  begin(out_of_slow, &out_of_slow.lane(1, 1));
  EXPECT_NEAR(planned_end_s(out_of_slow), 11.0, 1e-9) << "2 s to 1 m/s over 1 m, then 9 m";
  out_of_slow.clock(11.0);
  EXPECT_NEAR(out_of_slow.parts.drives.leg_ends(kFirst).speed_mps, 1.0, 1e-9);
}

TEST(DrivesPart, ADeviationDoesNotBreakALimit) {
  Scenario scenario = limited_row(1.0, 0.0, 0.0);
  scenario.vehicle_types[0].speed_deviation = 0.3;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    scenario.seed = seed;
    SmallWorld world(scenario);
    begin(world);
    const Piece& piece = std::get<SpatialEvolution>(world.run.agvs[0].activity->evolution).piece;
    for (double t = 0.1; t < 12.0; t += 0.1) EXPECT_LE(piece.speed_at(at_seconds(t)), 1.0 + 1e-12) << seed;
  }
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
}  // namespace fleetproof::drives_test
