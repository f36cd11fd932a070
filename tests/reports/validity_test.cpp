#include "reports/formats/validity.hpp"

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "tests/reports/sample_campaign.hpp"

namespace fleetproof::validity_test {
namespace {

using testing::HasSubstr;
using testing::Not;

ReportInput sample() {
  return samples::report_of(samples::campaign_of("claim", 2), samples::grid({"ours"}, {0.0, 0.4}, {1.0}), {});
}

std::string text_of(const ReportInput& input) { return validity_text(input, validity_checks(input)); }

// What the verdict has not counted is no failure.
TEST(Validity, TellsRunsThatRepeatOthers) {
  EXPECT_THAT(text_of(sample()), HasSubstr("ok    0 of 4 runs have a trace"));
  const ReportInput input =
      samples::report_of(samples::campaign_of("claim", 2), samples::grid({"ours"}, {0.0, 0.4}, {1.0}), {},
                         [](RunRecord& run) { run.repeats = run.replicate == 1; });
  EXPECT_THAT(text_of(input), HasSubstr("ok    2 of 4 runs have a trace"));
  EXPECT_THAT(text_of(input), HasSubstr("count for nothing"));
}

TEST(Validity, NothingElseFailsInASoundCampaign) { EXPECT_THAT(text_of(sample()), Not(HasSubstr("FAIL  "))); }

TEST(Validity, SaysTheVerdictAndTheExitCode) {
  ReportInput input = sample();
  input.exit_code = 4;
  EXPECT_THAT(text_of(input), HasSubstr("`fleetproof report` ends with exit code 4"));
}

TEST(Validity, AKnownAnswerThatComesOutOtherwiseEndsEverything) {
  EXPECT_NO_THROW(require_known_answers(validity_checks(sample())));
  EXPECT_NO_THROW(require_known_answers({{false, false, "a run ended in an error"}})) << "the verdict counts that";
  try {
    require_known_answers({{true, true, "fine"}, {false, true, "the generator gives the published answers"}});
    FAIL() << "it is not refused";
  } catch (const EngineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the generator gives the published answers"));
  }
}

TEST(Validity, AnErrorOfTheSimulatorFails) {
  const ReportInput input =
      samples::report_of(samples::campaign_of("claim", 2), samples::grid({"ours"}, {0.4}, {1.0}), {},
                         [](RunRecord& run) { run.outcome.engine_error = run.replicate == 1; });
  EXPECT_THAT(text_of(input), HasSubstr("FAIL  1 run ended in an error of the simulator"));
}

TEST(Validity, RunsOfSeveralProgramsFail) {
  CampaignRecord campaign = samples::campaign_of("claim", 2);
  campaign.engine.libraries = "SQLite 3" + std::string(kEngineBegun) + "another build";
  const ReportInput input = samples::report_of(campaign, samples::grid({"ours"}, {0.4}, {1.0}), {});
  EXPECT_THAT(text_of(input), HasSubstr("FAIL  all runs are those of one program"));
}

// Runs that only differ are software that is not deterministic, and no failure of the check.
TEST(Validity, AuditsThatWereJudgedOtherwiseFail) {
  const auto text = [](std::uint32_t failed) {
    return text_of(samples::report_of(samples::campaign_of("claim", 2), samples::grid({"ours"}, {0.4}, {1.0}), {}, {},
                                      0, 0, {samples::audit_of(0, false, {failed, 0}), samples::audit_of(1, true)}));
  };
  EXPECT_THAT(text(0), HasSubstr("ok    1 of 2 audited runs of ours came out differently"));
  EXPECT_THAT(text(bit_of(EndPoint::Contact)), HasSubstr("FAIL  1 of 2 audited runs of ours came out differently"));
}

}  // namespace
}  // namespace fleetproof::validity_test
