#include "laws/exact_law.hpp"

#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/laws/timeline.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::test::exact_law_test {
namespace {

LawResults exact(const Scene& scene) { return play(scene, make_exact_law); }

TEST(ExactLaw, BodiesThatOverlapAtRestAreOneContactOverTheWholeRun) {
  for (const double end_s : {30.0, 0.0}) {
    Scene scene(end_s);
    scene.agv(facing(0.0, 0.0, 1.0, 0.0));
    scene.agv(facing(1.0, 0.0, 1.0, 0.0));
    const auto violations = exact(scene).violations;
    ASSERT_EQ(violations.size(), 1U) << end_s;
    EXPECT_TRUE(violations[0].contact);
    EXPECT_EQ(violations[0].first, kStart);
    EXPECT_EQ(violations[0].last, scene.end);
    EXPECT_EQ(violations[0].min_clearance_um, 0) << "the depth is not measured";
    EXPECT_EQ(violations[0].x_um, 500000);
    EXPECT_EQ(violations[0].relative_speed_um_s, 0);
  }
}

TEST(ExactLaw, ObstaclesMayTouchEachOtherButNoAgv) {
  Scene scene(10.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0));
  scene.obstacle(facing(0.0, 1.05, 1.0, 0.0));
  scene.obstacle(facing(0.5, 1.05, 1.0, 0.0));
  const auto violations = exact(scene).violations;
  ASSERT_EQ(violations.size(), 2U);
  for (const Violation& violation : violations) EXPECT_EQ(violation.a, EntityId{0U});
}

TEST(ExactLaw, OneEpisodeCrossesTheSeamsOfBothTimelines) {
  Scene scene(20.0);
  // Side by side at 5 cm through rest, drive and rest again; the other is restless in pieces of its own.
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).wait_until(3.0).drive(1.5).wait_until(9.0).wait_until(9.0).wait_until(11.0);
  scene.agv(facing(0.8, 1.05, 1.0, 0.0)).wait_until(4.0).wait_until(9.0).wait_until(15.0);
  const auto violations = exact(scene).violations;
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].first, kStart);
  EXPECT_EQ(violations[0].last, scene.end);
  EXPECT_EQ(violations[0].closest_at, kStart);
  EXPECT_NEAR(static_cast<double>(violations[0].min_clearance_um), 50000.0, 1.0);
  EXPECT_FALSE(violations[0].contact);
}

TEST(ExactLaw, EachPassWithinOnePairOfPiecesIsAnEpisodeOfItsOwn) {
  Scene scene(20.0);
  // A square body spins through 20 rad, 0.4 m from a wall side-on and 7 cm corner-on: 13 corners come by.
  scene.agv(facing(0.0, 0.0, 1.0, 0.0), {1.6, 1.6}).turn(20.0, {1.5, 10.0, 10.0});
  scene.obstacle(facing(0.0, 1.3, 1.0, 0.0), {4.0, 0.2});
  const auto violations = exact(scene).violations;
  ASSERT_EQ(violations.size(), 13U);
  for (const Violation& violation : violations)
    EXPECT_NEAR(static_cast<double>(violation.min_clearance_um), 1.2e6 - 0.8e6 * std::sqrt(2.0), 1.1);
  for (std::size_t i = 1; i < violations.size(); ++i)
    EXPECT_GT(violations[i].first - violations[i - 1].last, std::chrono::milliseconds(300));
}

TEST(ExactLaw, SeesATurnOnTheSpotBesideAStandingBody) {
  Scene scene(10.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).wait_until(2.0).turn(kPi / 2.0);
  scene.agv(facing(0.0, 1.15, 1.0, 0.0));  // 0.15 m apart until the corner of the other comes round
  const LawResults findings = exact(scene);
  ASSERT_EQ(findings.violations.size(), 1U);
  EXPECT_TRUE(findings.violations[0].contact);
  EXPECT_GT(findings.violations[0].first, at_seconds(2.0));
  EXPECT_EQ(findings.violations[0].last, scene.end);
}

TEST(ExactLaw, TheClosestInstantOfAContactIsTheTouchWithItsSpeed) {
  for (const bool stopped : {false, true}) {
    Scene scene(8.0);
    // The nose has 6 m to the obstacle: 4 m and 4 s of gaining speed, 2 m at 2 m/s. The world stops it a micrometre
    // short, or nothing does.
    Timeline& agv = scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
    if (stopped) agv.cut_short_at(5.0 - 0.4e-6);
    scene.obstacle(facing(7.6, 0.0, 1.0, 0.0));
    const auto violations = exact(scene).violations;
    ASSERT_EQ(violations.size(), 1U);
    EXPECT_TRUE(violations[0].contact);
    EXPECT_NEAR(to_seconds(violations[0].closest_at), 5.0, 1e-6);
    EXPECT_NEAR(static_cast<double>(violations[0].relative_speed_um_s), 2e6, 10.0);
    EXPECT_EQ(violations[0].min_clearance_um, 0);
    EXPECT_GT(violations[0].last, at_seconds(6.0));
  }
}

TEST(ExactLaw, RelativeSpeedAddsUpForOncomingAndCancelsForFollowing) {
  for (const bool oncoming : {false, true}) {
    Scene scene(8.0);
    const Timeline& one = scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
    scene.agv(facing(oncoming ? 10.0 : 0.5, 1.05, oncoming ? -1.0 : 1.0, 0.0)).drive(10.0);
    const auto violations = exact(scene).violations;
    ASSERT_EQ(violations.size(), 1U);
    const double speed_mps = one.until(scene.end)[0].speed_at(violations[0].closest_at);
    EXPECT_NEAR(static_cast<double>(violations[0].relative_speed_um_s), oncoming ? 2e6 * speed_mps : 0.0, 1.0);
    if (oncoming) {
      EXPECT_GT(speed_mps, 1.5);
    }
  }
}

// A heading that is no unit vector means different bodies to the kernel and to FCL.
TEST(ExactLaw, AsksForASecondOpinionOnWhatItFiles) {
  Scene scene(8.0);
  scene.agv(facing(0.0, 0.0, 1.0, 0.0));
  scene.obstacle(facing(0.0, 1.05, 1.01, 0.0));
  EXPECT_THROW(exact(scene), InvariantViolation);
}

TEST(ExactLaw, ADriveCutShortHurtsNobodyBeyondItsEnd) {
  const auto scene_with = [](bool cut) {
    Scene scene(20.0);
    Timeline& agv = scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
    if (cut) agv.cut_short_at(3.0);
    scene.obstacle(facing(8.0, 0.0, 1.0, 0.0));
    return exact(scene);
  };
  EXPECT_EQ(scene_with(false).violations.size(), 1U);
  EXPECT_TRUE(scene_with(true).violations.empty());
  EXPECT_FALSE(scene_with(true).min_clearance_m);
}

TEST(ExactLaw, MeetsTheInstantOfArrival) {
  Scene scene(8.0);
  // Below the threshold only in the last tenth of a millimetre, and the run ends there.
  scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
  scene.obstacle(facing(11.6999, 0.0, 1.0, 0.0));
  const auto violations = exact(scene).violations;
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].last, at_seconds(8.0));
  EXPECT_NEAR(static_cast<double>(violations[0].min_clearance_um), 99900.0, 1.0);
  // 0.1 mm short of the threshold at 1 m/s2: sqrt(2 * 0.099 mm / 1) before the end.
  EXPECT_NEAR(to_seconds(violations[0].first), 8.0 - std::sqrt(2.0 * 99e-6), 1e-6);
}

TEST(ExactLaw, MeasuresTheSmallestClearanceBelowHalfAMetreOnly) {
  for (const double gap_m : {0.499, 0.501}) {
    Scene scene(12.0);
    scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
    scene.agv(facing(5.0, 1.0 + gap_m, 1.0, 0.0)).drive(1.0);
    const LawResults findings = exact(scene);
    EXPECT_TRUE(findings.violations.empty());
    EXPECT_EQ(findings.min_clearance_m.has_value(), gap_m < 0.5);
    if (findings.min_clearance_m) {
      EXPECT_NEAR(*findings.min_clearance_m, gap_m, 1e-6);
    }
  }
}

TEST(ExactLaw, BodiesFarApartCostNothing) {
  Scene scene(100.0);
  for (int i = 0; i < 10; ++i) scene.agv(facing(0.0, 5.0 * i, 1.0, 0.0)).drive(20.0).turn(kPi).drive(20.0);
  const LawResults findings = exact(scene);
  EXPECT_EQ(findings.distance_evaluations, 0U);
  EXPECT_EQ(findings.perimeter_checks, 0U);
}

TEST(ExactLaw, FollowsTheSafetyDistanceOfTheScenario) {
  for (const double safety_distance_m : {0.02, 0.04, 0.06, 0.4}) {
    Scene scene(12.0);
    scene.scenario.law.safety_distance_m = safety_distance_m;
    scene.agv(facing(0.0, 0.0, 1.0, 0.0)).drive(10.0);
    scene.agv(facing(5.0, 1.05, 1.0, 0.0));
    EXPECT_EQ(exact(scene).violations.size(), safety_distance_m > 0.05 ? 1U : 0U) << safety_distance_m;
  }
}

}  // namespace
}  // namespace fleetproof::test::exact_law_test
