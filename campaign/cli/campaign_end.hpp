#pragma once

#include <string>

#include "campaign/cli/attempt_log.hpp"

namespace fleetproof::cli {

struct EndWords {
  bool json = false, exit_zero = false;
};

// What `run` and `merge` do when the results file is written: the ledger gets the end of the attempt, standard output
// the verdict, CI its summary. Returns the exit code of the verdict.
int tell_verdict(const std::string& archive, AttemptLog& attempt, const EndWords& words);

}  // namespace fleetproof::cli
