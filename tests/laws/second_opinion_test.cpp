#include "laws/second_opinion.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/base/error.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof::test::second_opinion_test {
namespace {

OrientedRectangle at(double x_m, double y_m, double angle_rad = 0.0) {
  return {Vec2(x_m, y_m), unit_vector(angle_rad), 0.8, 0.5};
}

TEST(SecondOpinion, AgreesWithAClearanceThatIsRight) {
  confirm_clearance(at(0.0, 0.0), at(1.65, 0.0), 0.05);
  confirm_clearance(at(0.0, 0.0), at(1.6, 0.0), 0.0);
  confirm_clearance(at(0.0, 0.0), at(1.5, 0.0), -0.1);
  confirm_clearance(at(500.0, 300.0), at(501.65, 300.0), 0.05);
}

TEST(SecondOpinion, DeniesAClearanceThatIsWrong) {
  EXPECT_THROW(confirm_clearance(at(0.0, 0.0), at(1.65, 0.0), 0.0502), InvariantViolation);
  EXPECT_THROW(confirm_clearance(at(0.0, 0.0), at(1.65, 0.0), -0.01), InvariantViolation);
  EXPECT_THROW(confirm_clearance(at(0.0, 0.0), at(1.5, 0.0), 0.01), InvariantViolation);
}

TEST(SecondOpinion, DeniesNothingThatTheKernelMeasuresInCloseQuarters) {
  std::mt19937_64 random(7);
  const auto within = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int i = 0; i < 20000; ++i) {
    const OrientedRectangle first = at(within(-100.0, 100.0), within(-100.0, 100.0), within(-kPi, kPi));
    OrientedRectangle second = at(0.0, 0.0, within(-kPi, kPi));
    second.centre_m = first.centre_m + within(0.5, 2.0) * unit_vector(within(-kPi, kPi));
    confirm_clearance(first, second, clearance_m(first, second));
  }
}

// Bodies on a grid, as in a warehouse: where FCL's default solver errs by metres.
TEST(SecondOpinion, IsRightOnAGridToo) {
  for (int x = -40; x <= 40; ++x) {
    for (int y = -40; y <= 40; ++y) {
      const OrientedRectangle first = at(12.0, 7.0), second = at(12.0 + 0.1 * x, 7.0 + 0.1 * y);
      EXPECT_NO_THROW(confirm_clearance(first, second, clearance_m(first, second))) << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace fleetproof::test::second_opinion_test
