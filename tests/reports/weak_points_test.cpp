#include "reports/sections/weak_points.hpp"

#include <gmock/gmock.h>

#include "reports/page/wording.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::weak_points_test {
namespace {

using samples::campaign_of;
using samples::gate_of;
using samples::grid;
using samples::report_of;
using testing::HasSubstr;

std::string points_of(const ReportInput& input) { return joined(weak_points(input), "\n"); }

TEST(WeakPoints, AreNamed) {
  const auto input = report_of(
      campaign_of("claim", 10), grid({"sound", "other"}, {0.0, 0.4}, {2.0}),
      {gate_of("sound", GateKind::None, Region::Contract, 1e-3)},
      [](RunRecord& run) {
        if (run.cell == 1) run.outcome.counters.transports_done = 0;
        if (run.cell == 2 && run.replicate == 5) run.outcome.crash = true;
      },
      2);
  const std::string points = points_of(input);
  EXPECT_THAT(points, HasSubstr("2 of 42 stored runs are not counted"));
  EXPECT_THAT(points, HasSubstr("takes 2995"));
  EXPECT_THAT(
      points,
      HasSubstr("1 of 4 cells in the contract region completed no transport: sound on ring, fleet of 5, 40 %, 2 s"));
  EXPECT_THAT(points, HasSubstr("1 of 4 cells have runs with an unknown outcome"));
  EXPECT_THAT(points, HasSubstr("No gate judges agent other"));
}

TEST(WeakPoints, NoNumberOfWorldsIsOfferedToAGateWithAFailure) {
  for (const bool fails : {false, true}) {
    const auto input = report_of(campaign_of("claim", 10), grid({"sound"}, {0.4}, {2.0}),
                                 {gate_of("sound", GateKind::None, Region::Contract, 1e-3)}, [&](RunRecord& run) {
                                   if (fails && run.replicate == 3) samples::violate(run);
                                 });
    EXPECT_EQ(points_of(input).find("even without a failure") == std::string::npos, fails);
  }
}

}  // namespace
}  // namespace fleetproof::weak_points_test
