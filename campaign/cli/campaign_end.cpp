#include "campaign/cli/campaign_end.hpp"

#include "campaign/cli/ci_summary.hpp"
#include "campaign/cli/command_line.hpp"
#include "campaign/cli/render.hpp"
#include "campaign/cli/streams.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof::cli {

int tell_verdict(const std::string& archive, AttemptLog& attempt, const EndWords& words) {
  ReportInput input = read_report_input(ArchiveReader(archive), archive);
  attempt.end(input);
  add_history(input, attempt.path());
  if (words.json) {
    put_text(render(input, "json"));
  } else {
    put_text(render(input, "summary"));
    put("report: fleetproof report {}\n", shell_word(archive));
  }
  tell_ci(input);
  return words.exit_zero && input.exit_code != kEngineFault ? kDemonstrated : input.exit_code;
}

}  // namespace fleetproof::cli
