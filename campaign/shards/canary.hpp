#pragma once

#include <string>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"
#include "campaign/shards/shard_folder.hpp"

namespace fleetproof {

// A few fixed runs that every shard simulates before its own: a machine that computes differently is noticed before it
// publishes anything. One line for a reference agent in the worlds of the campaign, and one for each plug-in: the
// digest of what its runs came out as, or "unsteady" if they did not come out the same twice.
std::string canary_text(const CampaignPlan& plan, const AgentPrograms& programs, int workers);

// The first shard stores its canary in the folder. Others compare: throws MachineError if a line differs, and neither
// is unsteady, if the file is empty or incomplete, or if it cannot be written.
void check_canary(const ShardFolder& folder, const std::string& canary);

// The same for two folders: throws MachineError if their canaries differ, or if one is missing.
void require_same_canary(const ShardFolder& folder, const ShardFolder& other);

}  // namespace fleetproof
