#pragma once

#include <string>
#include <vector>

#include "campaign/plan/plan.hpp"

namespace fleetproof {

// The names of the agents that default gates bind: candidates, and plug-ins without a role. If the plan has none of
// these, all agents that are not marked as reference agents. `is_plugin`: by agent of the plan.
std::vector<std::string> agents_under_test(const CampaignPlan& plan, const std::vector<bool>& is_plugin);

// Gives a claim without gates those that every fleet has to meet, for each agent under test, in the contract region, or
// everywhere if it has no cell there: no violation, no crash, no load at a wrong place; per world at most kDefaultLimit
// of deadlocks, livelocks, starvation and hangs; and a throughput of at least a twentieth of what an AGV alone in the
// warehouse would do, but at most half of the demand. Runs that are too short for four transports are not judged by
// their throughput; the fleet has to reach it over all of them.
void add_default_gates(CampaignPlan& plan, const std::vector<bool>& is_plugin);

// Whether the gates of a plan are default gates. One that names the same gates is taken for one that names none.
bool has_default_gates(const CampaignPlan& plan);
// The floor of such a plan, and how it came about, for people: the first worlds of the layouts decide it.
std::string default_floor_text(const CampaignPlan& plan);

inline constexpr double kDefaultLimit = 0.1, kDefaultSafetyLimit = 0.01;

}  // namespace fleetproof
