// Each rule of hulls matters: for each there is a scene in which two AGVs meet, and only an agent that breaks the rule
// does not see it. The faulty agents that break one are the campaigns' yardstick.
#include <gtest/gtest.h>

#include <cmath>

#include "core/agents/hull.hpp"
#include "tests/agents/drawn_map.hpp"

namespace fleetproof::agents::hull_options_test {
namespace {

using testing::DrawnMap;
using testing::kTestAgv;

// AGV 0 drives the first lane, from the first station; AGV 1 stands at the last one. Bodies are 1.6 m x 1 m if not said
// otherwise.
struct Scene {
  DrawnMap map;
  fp_agv driving = kTestAgv, standing = kTestAgv;
  Vec first_heading{1.0, 0.0}, standing_heading{1.0, 0.0};
};

// A lane of 6 m to the east, and the station of the other AGV.
Scene lane_east(Vec other_m) {
  Scene scene;
  scene.map.station(0, 0), scene.map.station(6, 0);
  scene.map.segment(0, 1, false);
  scene.map.station(other_m.x, other_m.y);
  return scene;
}

bool conflicts(Scene& scene, const HullOptions& options) {
  testing::TestFleet fleet(scene.map.map(), 2, scene.driving);
  fleet.agvs[1] = scene.standing;
  const MapView map(scene.map.map());
  HullGeometry geometry(map, fleet.briefing(0, 0), options);
  Path driving, standing;
  driving.heading = scene.first_heading;
  driving.append(0);
  standing.station = map.station_count() - 1;
  standing.heading = scene.standing_heading;
  return geometry.conflict(0, driving, 1, standing);
}

void expect_only_seen_with(bool HullOptions::*rule, Scene scene) {
  EXPECT_TRUE(conflicts(scene, {}));
  HullOptions broken;
  broken.*rule = false;
  EXPECT_FALSE(conflicts(scene, broken));
}

TEST(HullRules, ABodyHasItsSizeWithALoad) {
  Scene scene = lane_east({3.0, 1.2});
  scene.driving.loaded_width_m = scene.standing.loaded_width_m = 1.4;
  expect_only_seen_with(&HullOptions::loads_count, scene);
}

TEST(HullRules, AnotherAgvHasTheSizeOfItsOwnType) {
  Scene scene = lane_east({3.0, 1.25});
  scene.standing.width_m = scene.standing.loaded_width_m = 1.4;
  expect_only_seen_with(&HullOptions::sizes_differ, scene);
}

TEST(HullRules, BodiesOfOneSizeDifferInTheirCentres) {
  Scene scene = lane_east({3.0, 2.0});
  scene.standing.centre_ahead_m = 0.6;
  scene.standing_heading = {0.0, -1.0};
  expect_only_seen_with(&HullOptions::centres_differ, scene);
}

TEST(HullRules, ATurnCoversFloor) {
  Scene scene = lane_east({0.0, 1.5});
  scene.first_heading = {0.0, 1.0};
  expect_only_seen_with(&HullOptions::turns_count, scene);
}

TEST(HullRules, ATurnReachesAsFarAsTheCorners) {
  for (const Vec first_heading : {Vec{0.0, 1.0}, Vec{-1.0, 0.0}}) {
    Scene scene = lane_east({0.0, 1.5});
    scene.map.segment(scene.map.station(0, -6), 0, false);  // from which AGVs come to the north
    scene.map.station(0.0, 1.5);
    scene.first_heading = first_heading;
    expect_only_seen_with(&HullOptions::corners_count, scene);
  }
}

TEST(HullRules, ABodyThatDrivesBackwardLiesOnTheOtherSide) {
  Scene scene = lane_east({-1.9, 0.0});
  scene.map.drive_backward(0);
  scene.driving.centre_ahead_m = scene.standing.centre_ahead_m = 0.6;
  scene.first_heading = {-1.0, 0.0};
  scene.standing_heading = {0.0, 1.0};
  expect_only_seen_with(&HullOptions::directions_count, scene);
}

TEST(HullRules, ALaneIsItsCurve) {
  Scene scene;
  scene.map.station(0, 0), scene.map.station(2, 2);
  scene.map.bend(0, 1, 1.0, 0.0, M_PI, 0.5);
  scene.map.station(2.19, -0.19);  // outside the middle of the bend
  scene.standing_heading = {M_SQRT1_2, M_SQRT1_2};
  expect_only_seen_with(&HullOptions::bends_count, scene);
}

TEST(HullRules, HullsKeepTheWholeSafetyDistance) {
  expect_only_seen_with(&HullOptions::margin_is_whole, lane_east({3.0, 1.09}));
}

TEST(HullRules, ShapesDecideWhateverTheStations) {
  expect_only_seen_with(&HullOptions::shapes_decide, lane_east({3.0, 0.5}));
}

}  // namespace
}  // namespace fleetproof::agents::hull_options_test
