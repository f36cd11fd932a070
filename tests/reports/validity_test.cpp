#include "reports/formats/validity.hpp"

#include <gmock/gmock.h>

#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::validity_test {
namespace {

using testing::HasSubstr;
using testing::Not;

RunRecord run_with_trace(std::uint64_t run_index, std::uint32_t cell, std::uint64_t digest) {
  RunRecord run = samples::clean_run(run_index, 2);
  run.cell = cell;
  run.outcome.digest = digest;
  return run;
}

ReportInput sample() {
  return samples::report_of(samples::campaign_of("claim", 2), samples::grid({"ours"}, {0.0, 0.4}, {1.0}), {});
}

TEST(Validity, EqualTracesCountInOneCellOnly) {
  DuplicateCheck duplicates;
  duplicates.add(run_with_trace(0, 0, 7));
  duplicates.add(run_with_trace(1, 1, 7));
  duplicates.add(run_with_trace(2, 0, 8));
  EXPECT_EQ(duplicates.repeated(), 0U) << "cells of a replicate share the world";
  EXPECT_THAT(validity_text(sample(), duplicates), HasSubstr("ok    0 of 3 runs have a trace"));
  duplicates.add(run_with_trace(4, 0, 7));
  duplicates.add(run_with_trace(6, 0, 7));
  EXPECT_THAT(validity_text(sample(), duplicates), HasSubstr("FAIL  2 of 5 runs have a trace"));
}

TEST(Validity, NothingElseFailsInASoundCampaign) {
  EXPECT_THAT(validity_text(sample(), DuplicateCheck()), Not(HasSubstr("FAIL")));
}

TEST(Validity, AnErrorOfTheSimulatorFails) {
  const ReportInput input =
      samples::report_of(samples::campaign_of("claim", 2), samples::grid({"ours"}, {0.4}, {1.0}), {},
                         [](RunRecord& run) { run.outcome.engine_error = run.replicate == 1; });
  EXPECT_THAT(validity_text(input, DuplicateCheck()), HasSubstr("FAIL  1 run ended in an error of the simulator"));
}

}  // namespace
}  // namespace fleetproof::validity_test
