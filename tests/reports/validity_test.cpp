#include "reports/formats/validity.hpp"

#include <gmock/gmock.h>

#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::validity_test {
namespace {

using testing::HasSubstr;
using testing::Not;

ReportInput sample() {
  return samples::report_of(samples::campaign_of("claim", 2), samples::grid({"ours"}, {0.0, 0.4}, {1.0}), {});
}

TEST(Validity, CountsRunsThatRepeatOthers) {
  EXPECT_THAT(validity_text(sample()), HasSubstr("ok    0 of 4 runs have a trace"));
  const ReportInput input =
      samples::report_of(samples::campaign_of("claim", 2), samples::grid({"ours"}, {0.0, 0.4}, {1.0}), {},
                         [](RunRecord& run) { run.repeats = run.replicate == 1; });
  EXPECT_THAT(validity_text(input), HasSubstr("FAIL  2 of 4 runs have a trace"));
}

TEST(Validity, NothingElseFailsInASoundCampaign) { EXPECT_THAT(validity_text(sample()), Not(HasSubstr("FAIL"))); }

TEST(Validity, AnErrorOfTheSimulatorFails) {
  const ReportInput input =
      samples::report_of(samples::campaign_of("claim", 2), samples::grid({"ours"}, {0.4}, {1.0}), {},
                         [](RunRecord& run) { run.outcome.engine_error = run.replicate == 1; });
  EXPECT_THAT(validity_text(input), HasSubstr("FAIL  1 run ended in an error of the simulator"));
}

}  // namespace
}  // namespace fleetproof::validity_test
