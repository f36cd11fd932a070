#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/cli/command_line.hpp"
#include "campaign/plan/campaign_file.hpp"
#include "campaign/run/agent_programs.hpp"
#include "storage/records.hpp"

namespace fleetproof::cli {

// Reads a campaign file, loads its plug-ins under their own names, checks the plan, and prints warnings on stderr.
// Throws InputError, with file, line and column, for an agent that is not known or cannot be loaded, and for a shared
// object whose agents have unlike `symbols`.
CampaignFile load_campaign(const std::string& path, AgentPrograms& programs);

// Throws InputError, which ends in `remedy`, if the file holds the results of a campaign: another file was meant.
void refuse_results(const std::string& path, std::string_view remedy);

// Draws the first worlds of each layout and fleet size, and prints warnings on stderr: worlds without room, fleets that
// may be too large. Throws InputError at the place of the fleet sizes if a fleet finds no room.
void try_first_worlds(const CampaignPlan& plan, const PlanPlaces& places);

// Calls `step`. If it throws NoRoom, throws InputError at the place of the fleet sizes instead.
void say_where_fleets_are(const PlanPlaces& places, const std::function<void()>& step);

// &AgentPrograms::know or &AgentPrograms::load.
using MeetPlugin = std::string (AgentPrograms::*)(const std::string& path, bool global_symbols);

// Adds the plug-ins of `agents`, which are agents of a stored campaign, to `programs`. Every file in `named` is met.
// The file of an agent that is not among them is the one that the campaign's last session remembers. Throws InputError
// if no session does, and what `meet` throws.
void meet_plugins(const std::string& archive_path, const CampaignRecord& campaign, std::span<const AgentFactor> agents,
                  const std::vector<std::string>& named, AgentPrograms& programs, MeetPlugin meet);

// Prints a warning on stderr for each plug-in of `agents` that is not the one with which the campaign was made. Call it
// before results are printed. Requires: the agents are known to `programs`.
void tell_rebuilt_plugins(const CampaignRecord& campaign, std::span<const AgentFactor> agents,
                          const AgentPrograms& programs);

// The name of the agent that `word` names: a name, or the path of a shared object. A path is added to `plugins`, and
// all of them are met, with RTLD_GLOBAL if they need `global_symbols`. Throws what `meet` throws.
std::string meet_agent(const std::string& word, std::vector<std::string>& plugins, AgentPrograms& programs,
                       MeetPlugin meet, bool global_symbols);
// The option --computer, of verbs that take scenario files: the programs of their computers, as NAME=PROGRAM; PROGRAM
// alone for the only one.
void add_computer_option(Options& options, std::vector<std::string>& programs);
// Puts those programs, names or paths of shared objects, in the place of those that the scenario names. Throws
// InputError if `what`, a file or a finding, has no such computer.
void take_computer_programs(Scenario& scenario, const std::vector<std::string>& programs, std::string_view what);
// Of each computer for which the scenario file names a program: that program, met as meet_agent does.
std::vector<ComputerPart> computer_parts(const Scenario& scenario, std::vector<std::string>& plugins,
                                         AgentPrograms& programs, MeetPlugin meet, bool global_symbols);

// The option --global-symbols, of verbs that open shared objects for which no campaign says which symbols they need.
void add_symbols_option(Options& options, bool& global_symbols);
// Throws InputError if the option was given and no part of `agent` comes from a shared object.
void refuse_idle_symbols(bool global_symbols, const AgentFactor& agent, const AgentPrograms& programs);
// What a command needs so that it plays this agent: " --plugin FILE" for each of its objects, with their symbols;
// nothing if it is built in. `folder`: paths are relative to it; empty: as they are.
std::string plugin_options(const AgentFactor& agent, const AgentPrograms& programs, const std::string& folder = "");

// The number that --jobs asks for; without it, one worker for each core. Throws InputError.
int worker_count(const std::optional<std::uint64_t>& jobs);

// The Keep that an option names; nothing if it was left out. Throws InputError.
std::optional<Keep> keep_of(const std::string& word);

}  // namespace fleetproof::cli
