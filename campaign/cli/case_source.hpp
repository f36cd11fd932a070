#pragma once

#include <string>
#include <vector>

#include "campaign/cli/command_line.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/shrink/trials.hpp"

namespace fleetproof::cli {

// How a user names a failing case: a run of a campaign, or a scenario file.
struct CaseWords {
  std::string verb;  // "shrink"
  std::string source, run;
  std::string agent, config;  // of a scenario file that names none
  std::vector<std::string> plugins;
};
void add_case_options(Options& options, CaseWords& words);

struct CaseSource {
  std::string name;  // "night-4711", or the name of the file without its extension
  Scenario scenario;
  CaseAgent agent;
  std::string stored_failure;  // how the run failed in the campaign; empty: not, or it is a scenario file
  std::string plugin;          // " --plugin FILE", as a command needs it that plays the case; empty: a reference agent
  std::string identity;        // of scenario, agent and program: what was learnt of one case says nothing of another
};

// Throws InputError. The agent is known to `programs` then; a plug-in is not loaded into this process.
CaseSource read_case(const CaseWords& words, AgentPrograms& programs);

// Simulates it. Throws InputError if it does not fail, and if it fails in another way the second time.
FailingCase failing_case(CaseHost& host, const CaseSource& source);

}  // namespace fleetproof::cli
