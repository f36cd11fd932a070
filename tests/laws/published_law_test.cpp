// What the published rule sees and, hole by hole, what it does not: the reasons for the exact law.
#include <gtest/gtest.h>

#include "laws/published_law.hpp"
#include "tests/laws/timeline.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::test::published_law_test {
namespace {

TEST(PaperLaw, AccusesWhatStandsInAnActivityPerimeterForTheWholeActivity) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).wait_until(1.0).drive(10.0);
  scene.agv(facing(5.0, 1.05, 1.0, 0.0));
  const LawResults findings = play(scene, make_paper_law);
  ASSERT_EQ(findings.violations.size(), 1U);
  EXPECT_EQ(findings.violations[0].first, at_seconds(1.0));
  EXPECT_EQ(findings.violations[0].last, at_seconds(9.0));
  EXPECT_NEAR(static_cast<double>(findings.violations[0].min_clearance_um), 50000.0, 1.0);
  EXPECT_EQ(findings.perimeter_checks, 1U);
}

TEST(PaperLaw, LeavesOutWhoIsTakenOffTheFloorMeanwhile) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  const Timeline& stands = scene.agv(facing(5.0, 1.05, 1.0, 0.0));
  const auto law = make_paper_law(scene.scenario);
  for (const Piece& piece : scene.bodies[0].until(scene.end)) law->piece_started(piece), law->piece_ended(piece);
  Piece before = stands.until(at_seconds(3.0))[0], after = before;
  after.begin = at_seconds(5.0), after.end = scene.end;
  for (const Piece& piece : {before, after}) law->piece_started(piece), law->piece_ended(piece);
  law->finish(scene.end);
  EXPECT_TRUE(law->findings().violations.empty());
}

TEST(PaperLaw, CountsAnObstacleAsAStationaryEntity) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.obstacle(facing(5.0, 1.05, 1.0, 0.0));
  scene.obstacle(facing(5.0, 5.0, 1.0, 0.0));
  const LawResults findings = play(scene, make_paper_law);
  EXPECT_EQ(findings.violations.size(), 1U);
  EXPECT_EQ(findings.perimeter_checks, 2U);
}

TEST(PaperLaw, ChecksEachOtherDriveOfTheInterval) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);                            // 0 .. 8
  scene.agv(facing(0.0, 9.0, 1.0, 0.0)).drive(1.5).wait_until(5.0).drive(1.5);  // 0 .. 3 and 5 .. 8
  // The first drive meets two activities, each of the others one.
  EXPECT_EQ(play(scene, make_paper_law).perimeter_checks, 4U);
}

TEST(PaperLaw, DrivesThatOnlyTouchInTimeHaveNothingInCommon) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(1.5);                   // 0 .. 3, to the other's side
  scene.agv(facing(1.5, 1.05, 1.0, 0.0)).wait_until(3.0).drive(1.5);  // 3 .. 6
  // Each finds the other stationary and in its perimeter.
  const LawResults findings = play(scene, make_paper_law);
  EXPECT_EQ(findings.perimeter_checks, 2U);
  ASSERT_EQ(findings.violations.size(), 1U);
  EXPECT_EQ(findings.violations[0].first, kStart);
  EXPECT_EQ(findings.violations[0].last, at_seconds(6.0));
}

TEST(PublishedLaws, AccuseAPairOnceWhicheverActivityItWasFoundFrom) {
  Scene scene(12.0);
  // The middle one of three, oncoming, is too close to both; each pair is found from two activities, with another pair
  // between.
  scene.agv(facing(10.0, -1.05, -1.0, 0.0)).drive(10.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(10.0, 1.05, -1.0, 0.0)).drive(10.0);
  for (const char* law : {"exact", "paper", "global-step"}) EXPECT_EQ(play(scene, law).violations.size(), 2U) << law;
}

// Hole 2: a violation shorter than the granularity.
TEST(PublishedHoles, SnapshotsStepOverShortViolations) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(20.0, 1.09, -1.0, 0.0)).drive(20.0);  // passes for less than a second
  ASSERT_EQ(play(scene, "exact").violations.size(), 1U);
  EXPECT_EQ(play(scene, "paper").violations.size(), 1U);
  scene.scenario.law.snapshot_s = 3.0;
  EXPECT_TRUE(play(scene, "paper").violations.empty());
}

// Hole 3: before(end) never looks at the arrival.
TEST(PublishedHoles, TheArrivalIsNotLookedAt) {
  Scene scene(8.0);
  scene.scenario.law.snapshot_s = 0.1;
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  // It arrives 0.0999 m in front of a body that creeps sideways all the time: below the threshold for the last 14 ms.
  scene.agv(facing(11.6999, 0.0, 0.0, 1.0), {1.0, 1.6}).drive(1.0, {0.01, 0.01, 0.01});
  EXPECT_EQ(play(scene, "exact").violations.size(), 1U);
  EXPECT_TRUE(play(scene, "paper").violations.empty());
  EXPECT_TRUE(play(scene, "global-step").violations.empty());
}

// Hole 4: an axis-aligned perimeter accuses an AGV parked well beside a diagonal; the clearance filed gives it away.
TEST(PublishedHoles, ADiagonalAccusesItsWholeBox) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 0.6, 0.8)).drive(10.0);
  scene.agv(facing(5.0, 1.0, 1.0, 0.0));
  EXPECT_TRUE(play(scene, "exact").violations.empty());
  const auto accused = play(scene, "paper").violations;
  ASSERT_EQ(accused.size(), 1U);
  EXPECT_GT(accused[0].min_clearance_um, 100000);
  EXPECT_TRUE(play(scene, "global-step").violations.empty());
}

// Hole 5: the corner of a widened box reaches 0.141 m.
TEST(PublishedHoles, SquareCornersAccuseUpTo141Millimetres) {
  Scene scene(8.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.obstacle(facing(10.8 + 0.09 + 0.5, 0.5 + 0.09 + 0.5, 1.0, 0.0),
                 {1.0, 1.0});  // 0.127 m corner to corner at the arrival
  EXPECT_TRUE(play(scene, "exact").violations.empty());
  const auto accused = play(scene, "global-step").violations;
  ASSERT_EQ(accused.size(), 1U);
  EXPECT_GT(accused[0].min_clearance_um, 100000);
}

TEST(PublishedHoles, TurnsAreNoDriveActivities) {
  Scene scene(10.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).wait_until(2.0).turn(kPi / 2.0);
  scene.agv(facing(0.0, 1.15, 1.0, 0.0));
  EXPECT_EQ(play(scene, "exact").violations.size(), 1U);
  for (const char* law : {"paper", "global-step"}) {
    EXPECT_TRUE(play(scene, law).violations.empty()) << law;
    EXPECT_EQ(play(scene, law).perimeter_checks, 0U) << law;
  }
}

TEST(GlobalStep, ChecksEveryOtherEntityAtEveryStep) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(1.5);  // 3 s
  scene.agv(facing(50.0, 0.0, 1.0, 0.0));
  scene.obstacle(facing(90.0, 0.0, 1.0, 0.0));
  EXPECT_EQ(play(scene, make_global_step_law).perimeter_checks, 2U * 1200U);
}

}  // namespace
}  // namespace fleetproof::test::published_law_test
