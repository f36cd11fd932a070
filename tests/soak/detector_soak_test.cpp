// The detector against a clock of 10 microseconds: a hundred thousand pairs, in ten parts.
#include <fmt/format.h>

#include "tests/oracle/detector_check.hpp"

namespace fleetproof::oracle::detector_soak_test {
namespace {

class DetectorSoak : public testing::TestWithParam<std::uint64_t> {};

TEST_P(DetectorSoak, AgreesWithATenMicrosecondClockOnTenThousandPairs) {
  const Tally tally = check_many(GetParam(), 10'000);
  fmt::print(
      "{} pairs: {} violated, {} of them touch, {} start below, {} within 10 um of the threshold; evaluations to the "
      "first instant: mean {:.2f}, "
      "at most {} with the smallest clearance\n",
      tally.pairs, tally.violations, tally.touches, tally.at_start, tally.within_10um,
      static_cast<double>(tally.evaluations) / static_cast<double>(tally.pairs), tally.most);
  EXPECT_EQ(tally.pairs, 10'000U);
}
INSTANTIATE_TEST_SUITE_P(Parts, DetectorSoak, testing::Range<std::uint64_t>(100, 110));

}  // namespace
}  // namespace fleetproof::oracle::detector_soak_test
