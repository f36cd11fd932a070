// The paper's own example, by every law: its counts, its violation, and the hole in the rule that it prints.
#include <gtest/gtest.h>

#include "tests/laws/timeline.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::test::figure4_test {
namespace {

constexpr double kMillisecond_s = 1e-3;

// AGVs A to E are entities 0 to 4.
Scene figure4() {
  Scene scene(12.0);
  const double y_m = 4.0 + 25.0 / 6.0;
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).wait_until(2.0).drive(10.0);
  scene.agv(facing(0.0, 4.0, 0.0, 1.0)).wait_until(4.0).drive(25.0 / 6.0);
  scene.agv(facing(1.39, y_m, 1.0, 0.0)).wait_until(7.0).drive(25.0 / 6.0);
  scene.agv(facing(6.85, 2.39, 0.0, -1.0)).wait_until(6.0).drive(1.5);
  scene.agv(facing(8.0, y_m, 1.0, 0.0)).wait_until(2.0).drive(1.5);
  return scene;
}

// X drives past Y, which stands 5 cm beside its track and leaves before X arrives.
Scene parked_then_leaves() {
  Scene scene(12.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.agv(facing(3.0, 1.35, 0.0, 1.0)).wait_until(5.0).drive(25.0 / 6.0);
  return scene;
}

void expect_a_and_d(const LawResults& findings) {
  ASSERT_EQ(findings.violations.size(), 1U);
  EXPECT_EQ(findings.violations[0].a, EntityId{0U});
  EXPECT_EQ(findings.violations[0].b, EntityId{3U});
  EXPECT_FALSE(findings.violations[0].contact);
}

TEST(Figure4, DrivesTakeThePapersTimes) {
  const Scene scene = figure4();
  const double ends_s[] = {10.0, 9.0, 12.0, 9.0, 5.0};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(scene.bodies[i].now(), at_seconds(ends_s[i])) << i;
}

TEST(Figure4, ActivityPerimetersOverlapForAAndDAndForBAndC) {
  const Scene scene = figure4();
  std::vector<Box> perimeters;
  for (const Timeline& body : scene.bodies) {
    const Piece drive = body.until(scene.end)[1];
    ASSERT_EQ(drive.manner, Manner::Drive);
    perimeters.push_back(drive.swept_box(drive.end).grown(scene.scenario.law.safety_distance_m));
  }
  for (std::size_t b = 1; b < 5; ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const bool expected = (a == 0 && b == 3) || (a == 1 && b == 2);
      EXPECT_EQ(perimeters[a].overlaps(perimeters[b]), expected) << a << " and " << b;
    }
  }
}

TEST(Figure4, ExactLawDatesTheViolationOfAAndD) {
  const LawResults findings = play(figure4(), "exact");
  expect_a_and_d(findings);
  const Violation& violation = findings.violations[0];
  EXPECT_NEAR(to_seconds(violation.first), 7.990, kMillisecond_s);
  EXPECT_LE(violation.first, at_seconds(7.990));
  EXPECT_NEAR(to_seconds(violation.last), 8.129, kMillisecond_s);
  EXPECT_GE(violation.last, at_seconds(8.129));
  EXPECT_NEAR(to_seconds(violation.closest_at), 8.080, kMillisecond_s);
  EXPECT_NEAR(static_cast<double>(violation.min_clearance_um), 14800.0, 100.0);
  ASSERT_TRUE(findings.min_clearance_m);
  EXPECT_EQ(violation.min_clearance_um, static_cast<std::int64_t>(std::floor(*findings.min_clearance_m * 1e6)));
  EXPECT_LE(findings.distance_evaluations, 60U);  // where the paper needs 4 020 checks
  EXPECT_EQ(findings.perimeter_checks, findings.distance_evaluations);
}

TEST(Figure4, RelativeSpeedAndPlaceAreThoseOfTheClosestInstant) {
  const Scene scene = figure4();
  const Violation violation = play(scene, "exact").violations.at(0);
  // A rolls along x at its level speed or brakes from it, D along -y.
  const Piece a = scene.bodies[0].until(scene.end)[1], d = scene.bodies[3].until(scene.end)[1];
  const double speed_mps = std::hypot(a.speed_at(violation.closest_at), d.speed_at(violation.closest_at));
  EXPECT_GT(speed_mps, 1.0);
  EXPECT_NEAR(static_cast<double>(violation.relative_speed_um_s), speed_mps * 1e6, 1.0);
  const Vec2 middle_m = 0.5 * (a.pose_at(violation.closest_at).position_m + d.pose_at(violation.closest_at).position_m);
  EXPECT_NEAR(static_cast<double>(violation.x_um), middle_m.x() * 1e6, 1.0);
  EXPECT_NEAR(static_cast<double>(violation.y_um), middle_m.y() * 1e6, 1.0);
}

TEST(Figure4, ExactLawMeasuresTheNearMissOfBAndC) {
  Scene scene(12.0);
  scene.agv(facing(0.0, 4.0, 0.0, 1.0)).wait_until(4.0).drive(25.0 / 6.0);
  scene.agv(facing(1.39, 4.0 + 25.0 / 6.0, 1.0, 0.0)).wait_until(7.0).drive(25.0 / 6.0);
  const LawResults findings = play(scene, "exact");
  EXPECT_TRUE(findings.violations.empty());
  ASSERT_TRUE(findings.min_clearance_m);
  EXPECT_NEAR(*findings.min_clearance_m, 0.1267, 1e-4);
}

TEST(Figure4, PaperLawNeeds4020Checks) {
  const LawResults findings = play(figure4(), "paper");
  expect_a_and_d(findings);
  // A 1 204, B 804, C 804, D 1 204, E 4. Any other pair of overlapping activity perimeters would add hundreds.
  EXPECT_EQ(findings.perimeter_checks, 4020U);
  EXPECT_FALSE(findings.min_clearance_m);
}

TEST(Figure4, GlobalStepNeeds38400Checks) {
  const LawResults findings = play(figure4(), "global-step");
  expect_a_and_d(findings);
  EXPECT_EQ(findings.perimeter_checks, 38400U);
}

TEST(Figure4, SnapshotsFindTheSameMinimumToTheirAccuracy) {
  for (const char* law : {"paper", "global-step"}) {
    const LawResults findings = play(figure4(), law);
    ASSERT_EQ(findings.violations.size(), 1U) << law;
    EXPECT_NEAR(to_seconds(findings.violations[0].first), 7.990, 0.0025 + kMillisecond_s) << law;
    EXPECT_NEAR(to_seconds(findings.violations[0].last), 8.129, 0.0025 + kMillisecond_s) << law;
    EXPECT_NEAR(static_cast<double>(findings.violations[0].min_clearance_um), 14800.0, 10000.0)
        << law;  // 1 cm, the paper's claim
  }
}

TEST(Figure4, SnapshotsOncePerSecondSeeOneInstant) {
  Scene scene = figure4();
  scene.scenario.law.snapshot_s = 1.0;
  const LawResults findings = play(scene, "paper");
  expect_a_and_d(findings);
  EXPECT_EQ(findings.violations[0].first, at_seconds(8.0));
  EXPECT_EQ(findings.violations[0].last, at_seconds(8.0));
}

TEST(ParkedThenLeaves, ExactLawFindsIt) {
  const LawResults findings = play(parked_then_leaves(), "exact");
  ASSERT_EQ(findings.violations.size(), 1U);
  EXPECT_NEAR(to_seconds(findings.violations[0].first), 2.540, kMillisecond_s);
  EXPECT_NEAR(to_seconds(findings.violations[0].last), 4.193, kMillisecond_s);
  EXPECT_NEAR(static_cast<double>(findings.violations[0].min_clearance_um), 50000.0, 1.0);
}

TEST(ParkedThenLeaves, PaperLawMissesItAtAnyGranularity) {
  for (const double snapshot_s : {1.0, 0.0025, 0.0001}) {
    Scene scene = parked_then_leaves();
    scene.scenario.law.snapshot_s = snapshot_s;
    EXPECT_TRUE(play(scene, "paper").violations.empty()) << snapshot_s;
  }
}

TEST(ParkedThenLeaves, GlobalStepFindsIt) {
  EXPECT_EQ(play(parked_then_leaves(), "global-step").violations.size(), 1U);
}

}  // namespace
}  // namespace fleetproof::test::figure4_test
