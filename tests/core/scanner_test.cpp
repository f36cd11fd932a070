#include "core/engine/scanner.hpp"

#include "tests/core/small_world.hpp"

namespace fleetproof::scanner_test {
namespace {

using test::kFirst;
using test::SmallWorld;

// A crate on the lane, 6 m ahead of the AGV's reference point.
Scenario with_crate() {
  Scenario scenario = test::row_of_tens({0});
  scenario.scanner.on = true;
  scenario.obstacles.push_back({"crate", {1.0, 1.0}, {Vec2{6.0, 0.0}, Vec2::UnitX()}});
  return scenario;
}
const EntityId kCrate{1U};

void drive(SmallWorld& world) {
  ASSERT_TRUE(world.parts.actions.accept(kFirst, FP_CALL_MOVE, 0));
  world.parts.actions.begin(kFirst, FP_CALL_MOVE, 0);
}

bool is_held(const SmallWorld& world) { return world.run.status(kFirst).is_held_by(Halt::Reason::Scanner); }

// Lets the scanner look, and activities end, until the AGV is held or is held no longer. When that was; -1: not before
// `end_s`.
double time_of(SmallWorld& world, bool held, double end_s) {
  while (!world.run.queue.empty()) {
    const Event event = world.run.queue.pop();
    if (to_seconds(event.at) >= end_s) return -1.0;
    world.run.now = event.at;
    if (event.kind == Event::Kind::ScannerLooks) world.parts.scanner.looks(kFirst, event.stamp);
    if (event.kind == Event::Kind::ActivityEnds && world.parts.activities.is_current(kFirst, event.stamp))
      world.parts.actions.activity_ends(kFirst);
    if (is_held(world) == held) return to_seconds(event.at);
  }
  return -1.0;
}

TEST(ScannerPart, StopsTheAgvAsSoonAsABodyIsInItsField) {
  SmallWorld world(with_crate());
  drive(world);
  const double stopped_s = time_of(world, true, 8.0);
  ASSERT_GT(stopped_s, 0.0);
  // The field reaches v * 0.08 s + v^2 / 2 + 0.15 m ahead of the nose; the crate begins at 5.5 m.
  const double v = 0.5 * stopped_s,
               nose_m = 0.25 * stopped_s * stopped_s + 0.5 * world.run.type_of(kFirst).footprint.length_m;
  EXPECT_GE(nose_m + v * 0.08 + v * v / 2.0 + 0.15, 5.5);
  EXPECT_LT(nose_m + v * 0.08 + v * v / 2.0 + 0.15, 5.5 + 2.0 * v * 0.08 + 0.1) << "one look earlier it was clear";
  EXPECT_EQ(world.run.counters.scanner_stops, 1U);
  EXPECT_EQ(world.run.counters.scanner_saves, 1U) << "a touch was under way";
}

// The AGV's nose points away from the crate; it comes tail first. Its centre is 0.3 m ahead of its reference point.
TEST(ScannerPart, LooksBehindWhileTheAgvDrivesBackward) {
  Scenario scenario = with_crate();
  Layout layout = scenario.map->layout();
  for (Segment& segment : layout.segments) segment.travel = Travel::Backward;
  scenario.map = std::make_shared<const LogicalMap>(layout);
  scenario.agvs[0].heading = Vec2(-1.0, 0.0);
  scenario.vehicle_types[0].footprint.centre_ahead_m = 0.3;
  SmallWorld world(scenario);
  drive(world);
  const double stopped_s = time_of(world, true, 8.0);
  ASSERT_GT(stopped_s, 0.0);
  const double v = 0.5 * stopped_s,
               tail_m = world.x_m(kFirst) - 0.3 + 0.5 * world.run.type_of(kFirst).footprint.length_m;
  EXPECT_GE(tail_m + v * 0.08 + v * v / 2.0 + 0.15, 5.5);
  EXPECT_LT(tail_m + v * 0.08 + v * v / 2.0 + 0.15, 5.5 + 2.0 * v * 0.08 + 0.1) << "one look earlier it was clear";
}

TEST(ScannerPart, DoesNotLookWhereTheNosePointsWhileTheAgvDrivesBackward) {
  Scenario scenario = with_crate();
  Layout layout = scenario.map->layout();
  for (Segment& segment : layout.segments) segment.travel = Travel::Backward;
  scenario.map = std::make_shared<const LogicalMap>(layout);
  scenario.agvs[0].heading = Vec2(-1.0, 0.0);
  scenario.obstacles[0].pose.position_m = {-2.0, 0.0};  // ahead of the nose, and the AGV drives away from it
  SmallWorld world(scenario);
  drive(world);
  EXPECT_EQ(time_of(world, true, 8.0), -1.0);
}

// How far the crate is from the nose when the scanner stops the AGV.
double gap_at_stop_m(const Scenario& scenario) {
  SmallWorld world(scenario);
  drive(world);
  EXPECT_GT(time_of(world, true, 8.0), 0.0);
  return 5.5 - world.x_m(kFirst) - 0.5 * world.run.type_of(kFirst).footprint.length_m;
}

TEST(ScannerPart, SeesNoFartherThanItsRange) {
  Scenario scenario = with_crate();
  const double needed_m = gap_at_stop_m(scenario);
  EXPECT_GT(needed_m, 1.5);
  scenario.scanner.range_m = 30.0;
  EXPECT_EQ(gap_at_stop_m(scenario), needed_m) << "a range beyond the braking way changes nothing";
  scenario.scanner.range_m = 1.0;
  EXPECT_LE(gap_at_stop_m(scenario), 1.0);
  EXPECT_GT(gap_at_stop_m(scenario), 1.0 - 2.0 * 2.0 * 0.08) << "one look earlier the crate was out of range";
}

TEST(ScannerPart, ARangeBelowTheBrakingWayStopsTooLate) {
  const auto stops_too_late = [](double range_m) {
    Scenario scenario = with_crate();
    scenario.scanner.range_m = range_m;
    SmallWorld world(scenario);
    drive(world);
    (void)time_of(world, true, 8.0);
    const double v = world.run.world.body(kFirst).piece.speed_at(world.run.now),
                 braking_m = v * v / (2.0 * world.run.type_of(kFirst).drive.deceleration_mps2);
    return braking_m > 5.5 - world.x_m(kFirst) - 0.5 * world.run.type_of(kFirst).footprint.length_m;
  };
  EXPECT_FALSE(stops_too_late(0.0));
  EXPECT_FALSE(stops_too_late(4.0));
  EXPECT_TRUE(stops_too_late(1.0));
}

TEST(ScannerPart, AStopThatComesTooLateIsNoSave) {
  for (const double range_m : {1.0, 0.0}) {
    Scenario scenario = with_crate();
    scenario.scanner.range_m = range_m;
    SmallWorld world(scenario);
    drive(world);
    ASSERT_GT(time_of(world, true, 8.0), 0.0);
    EXPECT_EQ(world.run.counters.scanner_stops, 1U);
    EXPECT_EQ(world.run.counters.scanner_saves, range_m > 0.0 ? 0U : 1U);
  }
}

TEST(ScannerPart, AStaleLookDoesNothing) {
  SmallWorld world(with_crate());
  drive(world);
  const Event event = world.next(Event::Kind::ScannerLooks);
  world.parts.scanner.looks(kFirst, event.stamp + 1);
  EXPECT_FALSE(world.has(Event::Kind::ScannerLooks)) << "an outdated look sets no further one";
}

TEST(ScannerPart, LetsTheAgvGoOnSomeTimeAfterTheFieldIsClear) {
  SmallWorld world(with_crate());
  drive(world);
  ASSERT_GT(time_of(world, true, 8.0), 0.0);
  world.run.world.take_off_floor(kCrate, world.run.now);
  const SimTime cleared = world.run.now;
  ASSERT_GT(time_of(world, false, 20.0), 0.0);
  EXPECT_NEAR(to_seconds(world.run.now - cleared), 2.08, 0.09) << "resume_s after the first look that saw it clear";
}

TEST(ScannerPart, AMutedFieldStopsNobodyUntilItHasBeenClear) {
  SmallWorld world(with_crate());
  drive(world);
  ASSERT_GT(time_of(world, true, 8.0), 0.0);
  world.parts.scanner.set_muted(kFirst, true);
  world.parts.halts.end_all(kFirst, Halt::Reason::Scanner);
  world.parts.scanner.looks(kFirst, 1);
  EXPECT_FALSE(is_held(world));
  world.parts.scanner.set_muted(kFirst, false);
  world.parts.scanner.looks(kFirst, 1);
  EXPECT_TRUE(is_held(world));
}

}  // namespace
}  // namespace fleetproof::scanner_test
