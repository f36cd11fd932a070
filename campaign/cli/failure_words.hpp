#pragma once

#include <string>
#include <vector>

#include "campaign/cli/command_line.hpp"
#include "core/outcome/run_failures.hpp"

namespace fleetproof::cli {

// `--failure`: which failure of a run a verb looks at.
void add_failure_option(Options& options, std::string& word);

// The one that the word names: of this end point, or of a heavier level of violation if there is none of this. No word:
// the failure that leads. Throws InputError, which names the failures that the run has, if it has none of this.
FailureChoice choice_of(const std::string& word, const Outcome& outcome);
// By the end point alone, without a run. Throws InputError if no end point has this word.
FailureChoice choice_of(const std::string& word);

// "contact, two AGVs at 231.40 s (AGV 1, AGV 4)": bodies by their numbers.
std::string told(const RunFailure& failure);
// What else went wrong beside this failure, in one line without its end: "also in this run: deadlock, two AGVs from
// 20.00 s, over before the end (--failure deadlock)". Empty: nothing. The option is named where the verb has it.
enum class OptionNamed : bool { No, Yes };
std::string others_line(const Outcome& outcome, const RunFailure& told, OptionNamed option);

}  // namespace fleetproof::cli
