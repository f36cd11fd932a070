#include "campaign/cli/campaign_end.hpp"

#include "campaign/cli/ci_summary.hpp"
#include "campaign/cli/command_line.hpp"
#include "campaign/cli/render.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/waived.hpp"
#include "core/base/error.hpp"
#include "reports/sections/head_notes.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof::cli {
namespace {

ExitCode code_of(Conclusion conclusion) {
  switch (conclusion) {
    case Conclusion::Demonstrated:
      return kDemonstrated;
    case Conclusion::Violated:
      return kViolated;
    case Conclusion::NotDemonstrated:
      return kNotDemonstrated;
    case Conclusion::EngineFault:
      return kEngineFault;
  }
  invariant_violated("a conclusion has an exit code");
}

}  // namespace

int exit_code_of(const ReportInput& input, bool exit_zero) {
  const Conclusion conclusion = conclusion_of(input);
  return exit_zero && conclusion != Conclusion::EngineFault ? kDemonstrated : code_of(conclusion);
}

void add_exit_code(ReportInput& input) { input.exit_code = code_of(conclusion_of(input)); }

std::vector<Headline> head_of_release(const ArchiveReader& archive, const std::string& path) {
  ReportInput input = read_report_input(archive, path);
  input.waived = lenient_conditions(input.campaign.plan_json);
  add_history(input, "");
  return head_beside_verdict(input);
}

int tell_verdict(const std::string& archive, AttemptLog& attempt, const EndWords& words) {
  ReportInput input = read_report_input(ArchiveReader(archive), archive);
  add_exit_code(input);
  input.waived = lenient_conditions(input.campaign.plan_json);
  attempt.end(input);
  add_history(input, attempt.path());
  if (words.json) {
    put_text(render(input, "json"));
  } else {
    put_text(render(input, "summary"));
    put("report: fleetproof report {}\n", shell_word(archive));
  }
  tell_ci(input);
  return exit_code_of(input, words.exit_zero);
}

}  // namespace fleetproof::cli
