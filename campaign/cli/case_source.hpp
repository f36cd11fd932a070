#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/cli/command_line.hpp"
#include "campaign/cli/work_time.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/shrink/trials.hpp"

namespace fleetproof::cli {

// How a user names a failing case: a run of a campaign, or a scenario file.
struct CaseWords {
  std::string verb;  // "shrink"
  std::string source, run;
  std::string agent, config;  // of a scenario file that names none
  std::string failure;        // which failure of the run; empty: the one that leads
  std::vector<std::string> plugins;
  std::vector<std::string> computers;  // of a scenario file: programs of its computers, as NAME=PROGRAM
  bool global_symbols = false;         // of a scenario file
};
void add_case_options(Options& options, CaseWords& words);

struct CaseSource {
  std::string name;  // "night-4711", or the name of the file without its extension
  Scenario scenario;
  CaseAgent agent;
  std::string failure;            // as CaseWords
  std::optional<Outcome> stored;  // of the run in the campaign; absent: it is not stored, or it is a scenario file
  std::string recording;          // the command that plays what its agents did then; empty: that is not recorded
  std::string command;            // "night.db 4711", or the scenario file, as words of a command line
  std::string plugin;             // as plugin_options has it; empty: a reference agent
  std::string identity;           // of scenario, agent and program: what was learnt of one case says nothing of another
};

// Throws InputError. The agent is known to `programs` then; a plug-in is not loaded into this process.
CaseSource read_case(const CaseWords& words, AgentPrograms& programs);

// A failing case, as the repetitions of its run have it.
struct ExaminedCase {
  FailingCase failing;
  FailureChoice choice;
  std::string others;  // what else went wrong in the run, as others_line has it
  double run_s = 0.0;  // that one run took
};
// Simulates it in fresh processes. Throws InputError if it does not fail, and if it does not fail twice as it is
// stored: the same end point, the same bodies. Throws GivenUp if the time, or a signal, ends it before that is known.
ExaminedCase failing_case(const CaseHost& host, const CaseSource& source, const WorkTime& time);

// What was found by trying many changed runs fails as it says whenever it is simulated. Throws InputError if it does
// not: then its software does not always do the same. Reference agents do.
void require_steady(const CaseHost& host, const CaseSource& source, const FailingCase& found,
                    const FailurePattern& pattern);

}  // namespace fleetproof::cli
