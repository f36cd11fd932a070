#pragma once

#include <string>

#include "storage/records.hpp"

namespace fleetproof {

// What differs between a stored campaign and the one that is to go on in its file, as "plan/seed: stored 77, now 78;
// ..."; empty: nothing. The plan decides the outcomes of runs. The number of replicates is no difference. A key that
// the stored plan does not have counts with its default.
std::string plan_differences(const CampaignRecord& stored, const CampaignRecord& now);
// The same for the engine, which computes the outcomes.
std::string engine_differences(const EngineIdentity& stored, const EngineIdentity& now);

// Whether the program and the plug-ins of this session made all runs in the file.
bool has_one_engine(const EngineIdentity& stored, const EngineIdentity& now);

// Throws InputError with the reason if the campaign `now` must not go on in the file `path`: another plan, fewer
// replicates, more replicates of a latin hypercube or for a fixed gate, or another engine without `allow_drift`.
// Otherwise the engine libraries of `now` name all engines that wrote to the file.
void require_same_campaign(const std::string& path, const CampaignRecord& stored, CampaignRecord& now,
                           bool allow_drift);

}  // namespace fleetproof
