#pragma once

#include <cstdint>
#include <string>

#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"

namespace fleetproof {

// The software under test, as 64 hex digits: of each agent under test its name, the SHA-256 of its shared object (of
// this program, for a reference agent) and its parameters. Another build of the same agent is another release.
std::string release_digest(const CampaignPlan& plan, const AgentPrograms& programs);

// The seed of `seed = "fresh"`: it follows from the release and from the plan without seed, name and number of
// replicates. Each release gets worlds that nobody has seen before, and nobody can choose among seeds.
std::uint64_t fresh_seed(const CampaignPlan& plan, const AgentPrograms& programs);

}  // namespace fleetproof
