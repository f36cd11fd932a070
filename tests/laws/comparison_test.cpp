// Each hole of the published rules, told by its cause.
#include "laws/comparison.hpp"

#include <gtest/gtest.h>

#include "tests/laws/timeline.hpp"

namespace fleetproof::test::comparison_test {
namespace {

std::vector<Difference> differences(const Scene& scene, std::string_view law) {
  TimelineKeeper timelines(scene.scenario);
  Announcer(scene, timelines).announce(Order::ByEntity);
  return compare(scene.scenario, play(scene, law), play(scene, "safety-distance"), timelines);
}

void expect_only(const Scene& scene, std::string_view law, bool missed, DifferenceCause cause) {
  const auto found = differences(scene, law);
  ASSERT_EQ(found.size(), 1U) << law;
  EXPECT_EQ(found[0].missed, missed) << law;
  EXPECT_EQ(found[0].cause, cause) << law << ": " << name_of(found[0].cause);
}

TEST(Comparison, NothingToTellWhereBothAgree) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(10.0, 1.05, -1.0, 0.0)).drive(10.0);
  for (const char* law : {"paper", "global-step"}) EXPECT_TRUE(differences(scene, law).empty()) << law;
}

TEST(Comparison, ARestCheckedByNobody) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(3.0, 1.35, 0.0, 1.0)).wait_until(5.0).drive(4.0);  // rests 5 cm beside the track, leaves later
  expect_only(scene, "paper", true, DifferenceCause::RestPhase);
  EXPECT_TRUE(differences(scene, "global-step").empty());
}

TEST(Comparison, AViolationBetweenTwoSnapshots) {
  Scene scene(12.0);
  scene.scenario.law.snapshot_s = 3.0;
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(20.0, 1.09, -1.0, 0.0)).drive(20.0);
  expect_only(scene, "paper", true, DifferenceCause::BetweenSnapshots);
  expect_only(scene, "global-step", true, DifferenceCause::BetweenSnapshots);
}

TEST(Comparison, TheArrival) {
  Scene scene(8.0);
  scene.scenario.law.snapshot_s = 0.1;
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(11.6999, 0.0, 0.0, 1.0), {1.0, 1.6}).drive(1.0, {0.01, 0.01, 0.01});
  expect_only(scene, "paper", true, DifferenceCause::LastInstant);
  expect_only(scene, "global-step", true, DifferenceCause::LastInstant);
}

TEST(Comparison, ATurnIsNoDriveActivity) {
  Scene scene(10.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).wait_until(2.0).turn(kPi / 2.0);
  scene.agv(facing(0.0, 1.15, 1.0, 0.0));
  for (const char* law : {"paper", "global-step"}) expect_only(scene, law, true, DifferenceCause::NoDriveActivity);
}

TEST(Comparison, ADiagonalAccusesItsWholeBox) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 0.6, 0.8)).drive(10.0);
  scene.agv(facing(5.0, 1.0, 1.0, 0.0));
  expect_only(scene, "paper", false, DifferenceCause::AxisAlignedPerimeter);
  EXPECT_TRUE(differences(scene, "global-step").empty());
}

TEST(Comparison, ASquareCornerAccuses) {
  Scene scene(8.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.obstacle(facing(10.8 + 0.09 + 0.5, 0.5 + 0.09 + 0.5, 1.0, 0.0), {1.0, 1.0});
  expect_only(scene, "paper", false, DifferenceCause::SquareCorners);
  expect_only(scene, "global-step", false, DifferenceCause::SquareCorners);
}

TEST(Comparison, MissesAndAccusationsStandTogetherInOrderOfTime) {
  Scene scene(30.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).wait_until(10.0).drive(10.0);
  scene.agv(facing(3.0, 1.35, 0.0, 1.0)).wait_until(15.0).drive(4.0);
  scene.agv(facing(50.0, 0.0, 0.6, 0.8)).drive(10.0);
  scene.agv(facing(55.0, 1.0, 1.0, 0.0));
  const auto found = differences(scene, "paper");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_FALSE(found[0].missed);
  EXPECT_TRUE(found[1].missed);
}

}  // namespace
}  // namespace fleetproof::test::comparison_test
