#include "reports/wording.hpp"

#include <gtest/gtest.h>

namespace fleetproof {
namespace {

TEST(Wording, ClearancesAreRoundedDown) {
  EXPECT_EQ(metres_text(0), "0.00 m");
  EXPECT_EQ(metres_text(9'999), "0.00 m");
  EXPECT_EQ(metres_text(99'999), "0.09 m");
  EXPECT_EQ(metres_text(100'000), "0.10 m");
  EXPECT_EQ(metres_text(289'999), "0.28 m");
  EXPECT_EQ(metres_text(290'000), "0.29 m");
}

TEST(Wording, DistancesOfAPlanKeepAllTheirDigits) {
  EXPECT_EQ(distance_text(0.1), "0.10 m");
  EXPECT_EQ(distance_text(0.25), "0.25 m");
  EXPECT_EQ(distance_text(0.105), "0.105 m");
  EXPECT_EQ(distance_text(1.0), "1.00 m");
}

}  // namespace
}  // namespace fleetproof
