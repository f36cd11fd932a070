#pragma once

#include <functional>
#include <string>
#include <vector>

#include "campaign/findings/findings_file.hpp"
#include "campaign/plan/plan.hpp"
#include "campaign/run/agent_programs.hpp"

namespace fleetproof {

// The smallest case of a known finding, played with an agent of a campaign.
struct PlayedCase {
  std::string id, agent;
  IssueStatus status = IssueStatus::Known;
  bool fails_so = false;
  std::string outcome;  // "contact, two AGVs (driving)", or "none"
};

// All cases of a findings file with all agents of the plan, in this order. They tell at once what is back; they count
// in no claim, because they were chosen for their failures. Throws GivenUp once
// `go_on` says no, also out of the middle of a run.
std::vector<PlayedCase> play_known_cases(const FindingsFile& file, const CampaignPlan& plan,
                                         const AgentPrograms& programs, int workers,
                                         const std::function<bool()>& go_on);

}  // namespace fleetproof
