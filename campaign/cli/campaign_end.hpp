#pragma once

#include <string>
#include <vector>

#include "campaign/cli/attempt_log.hpp"
#include "reports/sections/report_input.hpp"

namespace fleetproof::cli {

struct EndWords {
  bool json = false, exit_zero = false;
};

// The exit code of a report: 0 if the user asked for that, unless the engine made an error.
int exit_code_of(const ReportInput& input, bool exit_zero);
// Adds the one of the conclusion, for the formats that repeat it.
void add_exit_code(ReportInput& input);

// What stands at the head of the report on a results file beside the verdict: for comparisons with it.
std::vector<Headline> head_of_release(const ArchiveReader& archive, const std::string& path);

// What `run` and `merge` do when the results file is written: the ledger gets the end of the attempt, standard output
// the verdict, CI its summary. Returns the exit code of the verdict.
int tell_verdict(const std::string& archive, AttemptLog& attempt, const EndWords& words);

}  // namespace fleetproof::cli
