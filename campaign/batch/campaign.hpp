#pragma once

#include <string>

#include "campaign/batch/session.hpp"
#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"

namespace fleetproof {

// Runs the plan and leaves its results file at `path`. Agents of plug-ins run in worker processes
// (campaign/workers); reference agents run on the threads of the pool. A share of the runs is audited beside them. Rows
// are stored when their runs finish. The published file contains the gap-free prefix of run indices. The same runs
// therefore give the same bytes with any number of workers, in any order of finishing, in one session or several. A
// file that exists already goes on: its runs are not simulated again. Throws InputError and writes nothing if an agent
// is not known, if a layout has no room for its fleet, or if the file holds another campaign.
CampaignResult run_campaign(const CampaignPlan& plan, const AgentPrograms& programs, const std::string& path,
                            const RunOptions& options, const CampaignListener& listener);

}  // namespace fleetproof
