#pragma once

#include <string>

#include "storage/records.hpp"

namespace fleetproof {

// Why two campaigns did not run in the same worlds, judged by the same laws: "the plans differ in /horizon_s". Empty:
// they did, if their cells are the same. Names, agents, gates, limits, audits and the number of replicates are no
// difference.
std::string world_difference(const CampaignRecord& one, const CampaignRecord& other);

}  // namespace fleetproof
