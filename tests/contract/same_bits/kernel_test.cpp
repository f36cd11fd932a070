// The planar kernel on a million pairs, in thirds: anywhere, on a lattice, parallel with a gap of nothing up to the
// safety distance.
#include "tests/oracle/rectangle_check.hpp"

namespace fleetproof::test::kernel_test {
namespace {

constexpr int kPairs = 334'000;

TEST(Kernel, IsExactAnywhere) {
  Random random;
  for (int i = 0; i < kPairs; ++i) {
    const double range_m = i % 2 == 0 ? 5.0 : 15.0;
    const OrientedRectangle a = random.anywhere(range_m), b = random.anywhere(range_m);
    ASSERT_NO_FATAL_FAILURE(check_pair(a, b)) << i;
  }
}

TEST(Kernel, IsExactOnALattice) {
  Random random;
  int touching = 0;
  for (int i = 0; i < kPairs; ++i) {
    const OrientedRectangle a = random.on_lattice(), b = random.on_lattice();
    touching += std::abs(clearance_m(a, b)) < 1e-12;
    ASSERT_NO_FATAL_FAILURE(check_pair(a, b)) << i;
  }
  EXPECT_GT(touching, 1000);
}

TEST(Kernel, IsExactForParallelAndTouchingPairs) {
  Random random;
  for (int i = 0; i < kPairs; ++i) {
    const double gap_m = i % 5 == 0   ? 0.0
                         : i % 5 == 1 ? 1e-9
                         : i % 5 == 2 ? -1e-9
                         : i % 5 == 3 ? 0.10
                                      : random.in(-0.1, 0.1);
    const auto [a, b] = random.beside(500.0, gap_m);
    ASSERT_NO_FATAL_FAILURE(check_pair(a, b)) << i;
    if (gap_m >= 0.0) {
      ASSERT_NEAR(clearance_m(a, b), gap_m, 1e-12) << i;
    }
  }
}

}  // namespace
}  // namespace fleetproof::test::kernel_test
