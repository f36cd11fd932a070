// The detector against a clock of 10 microseconds: two thousand pairs. A hundred thousand are in soak/.
#include "tests/oracle/detector_check.hpp"

namespace fleetproof::oracle::detector_test {
namespace {

TEST(Detector, AgreesWithATenMicrosecondClockOnTwoThousandPairs) { EXPECT_EQ(check_many(20261, 2'000).pairs, 2'000U); }

}  // namespace
}  // namespace fleetproof::oracle::detector_test
