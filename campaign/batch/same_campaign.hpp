#pragma once

#include <string>

#include "storage/records.hpp"

namespace fleetproof {

// What differs between a stored campaign and the one that is to go on in its file, one line each; empty: nothing. More
// replicates are no difference. "plan: ..." is what decides the outcomes of runs, "engine: ..." what computes them.
std::string plan_differences(const CampaignRecord& stored, const CampaignRecord& now);
std::string engine_differences(const EngineIdentity& stored, const EngineIdentity& now);

// Throws InputError with the differences if the campaign `now` must not go on in the file `path`. Another plan never
// may; another engine may if `allow_drift`, and then `now` records it.
void require_same_campaign(const std::string& path, const CampaignRecord& stored, CampaignRecord& now,
                           bool allow_drift);

}  // namespace fleetproof
