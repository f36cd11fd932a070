#pragma once

#include <string>
#include <vector>

#include "campaign/shards/shard_folder.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// The campaign of a folder of shards, as its plan.db holds it: a results file without runs. SQLite locks the files
// that it opens, which a network disk may not be able to; so it works on copies in the local folder for temporary
// files ($TMPDIR).
struct StoredPlan {
  CampaignRecord campaign;
  std::vector<CellRecord> cells;
  std::vector<GateRecord> gates;
};

// Throws InputError if there is no plan, EngineError if it is damaged, MachineError if the disk fails.
StoredPlan read_plan(const ShardFolder& folder);

// Writes the plan, unless there is one. Its bytes are the same on every machine. Throws MachineError if the disk fails.
void publish_plan(const ShardFolder& folder, const StoredPlan& plan);

}  // namespace fleetproof
