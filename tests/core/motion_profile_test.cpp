#include "core/motion/motion_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/error.hpp"

namespace fleetproof::motion_profile_test {
namespace {

TEST(MotionProfile, ThePapersThreeDurations) {
  EXPECT_EQ(MotionProfile(1.5, {}).duration(), Duration{3'000'000'000});
  EXPECT_EQ(MotionProfile(25.0 / 6.0, {}).duration(), Duration{5'000'000'000});
  EXPECT_EQ(MotionProfile(10.0, {}).duration(), Duration{8'000'000'000});
  EXPECT_DOUBLE_EQ(MotionProfile(1.5, {}).speed(2.0), 1.0);
  EXPECT_DOUBLE_EQ(MotionProfile(25.0 / 6.0, {}).speed(10.0 / 3.0), 5.0 / 3.0);
  EXPECT_DOUBLE_EQ(MotionProfile(10.0, {}).speed(5.0), 2.0);
}

TEST(MotionProfile, TrianglesAndTrapezoidsMeetAtSixMetres) {
  EXPECT_EQ(MotionProfile(6.0, {}).duration(), Duration{6'000'000'000});
  const auto ends = MotionProfile(6.0, {}).phase_ends_s();
  EXPECT_DOUBLE_EQ(ends[0], 4.0);
  EXPECT_DOUBLE_EQ(ends[1], 4.0);
  EXPECT_DOUBLE_EQ(ends[2], 6.0);
  EXPECT_DOUBLE_EQ(MotionProfile(6.2, {}).phase_ends_s()[1], 4.1);
}

TEST(MotionProfile, NoWayTakesNoTime) {
  const MotionProfile nothing(0.0, {}), blank;
  for (const MotionProfile& profile : {nothing, blank}) {
    EXPECT_EQ(profile.duration(), Duration{0});
    EXPECT_EQ(profile.position(1.0), 0.0);
    EXPECT_EQ(profile.speed(0.0), 0.0);
    EXPECT_EQ(profile.time_at(0.0), 0.0);
  }
}

TEST(MotionProfile, ClampsBeforeAndAfter) {
  for (const double distance : {1e-6, 0.3, 1.5, 25.0 / 6.0, 7.7, 123.4}) {
    const MotionProfile profile(distance, {});
    EXPECT_EQ(profile.position(-1.0), 0.0);
    EXPECT_EQ(profile.position(0.0), 0.0);
    EXPECT_EQ(profile.position(to_seconds(profile.duration())), distance);
    EXPECT_EQ(profile.position(1e6), distance);
    EXPECT_EQ(profile.speed(-1.0), 0.0);
    EXPECT_EQ(profile.speed(1e6), 0.0);
  }
}

std::size_t phase_at(const MotionProfile& profile, double t_s) {
  const auto& ends_s = profile.phase_ends_s();
  return t_s < ends_s[0] ? 0 : t_s < ends_s[1] ? 1 : 2;
}

TEST(MotionProfile, SpeedIsTheSlopeOfPositionAndAccelerationThatOfSpeed) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const MotionLimits limits{0.3 + 3.0 * unit(engine), 0.2 + 2.0 * unit(engine), 0.2 + 2.0 * unit(engine)};
    const MotionProfile profile(0.05 + 20.0 * unit(engine) * unit(engine), limits);
    const double whole_s = to_seconds(profile.duration()), h = 1e-5 * whole_s;
    for (int k = 1; k < 100; ++k) {
      const double t = whole_s * k / 100.0;
      // Continuous, and across a change of phase too: the slope of a chord is the mean of the speeds at its ends, but
      // for what accelerations differ.
      const double slope = (profile.position(t + h) - profile.position(t - h)) / (2.0 * h);
      ASSERT_NEAR(slope, profile.speed(t), (limits.acceleration_mps2 + limits.deceleration_mps2) * h + 1e-8);
      ASSERT_LE(profile.speed(t), limits.speed_mps);
      const double a = profile.acceleration_in_phase(phase_at(profile, t));
      ASSERT_TRUE(a == limits.acceleration_mps2 || a == 0.0 || a == -limits.deceleration_mps2);
      if (phase_at(profile, t - h) == phase_at(profile, t + h)) {
        ASSERT_NEAR((profile.speed(t + h) - profile.speed(t - h)) / (2.0 * h), a, 1e-6);
      }
    }
  }
}

TEST(MotionProfile, TimeAtInvertsPosition) {
  for (const double distance : {0.4, 1.5, 25.0 / 6.0, 6.0, 10.0}) {
    const MotionProfile profile(distance, {});
    for (int k = 1; k < 50; ++k) {
      const double s = distance * k / 50.0;
      EXPECT_NEAR(profile.position(profile.time_at(s)), s, 1e-12);
    }
    EXPECT_EQ(profile.time_at(-1.0), 0.0);
    EXPECT_DOUBLE_EQ(profile.time_at(distance), profile.phase_ends_s()[2]);
    EXPECT_DOUBLE_EQ(profile.time_at(distance + 1.0), profile.phase_ends_s()[2]);
  }
}

TEST(MotionProfile, RefusesWhatIsNoMotion) {
  EXPECT_THROW(MotionProfile(-1.0, {}), InvariantViolation);
  EXPECT_THROW(MotionProfile(std::nan(""), {}), InvariantViolation);
  EXPECT_THROW(MotionProfile(1.0, {0.0, 0.5, 1.0}), InvariantViolation);
  EXPECT_THROW(MotionProfile(1.0, {2.0, -0.5, 1.0}), InvariantViolation);
}

}  // namespace
}  // namespace fleetproof::motion_profile_test
