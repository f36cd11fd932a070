#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "campaign/batch/campaign.hpp"
#include "campaign/shards/chunk_grid.hpp"
#include "campaign/shards/shard_folder.hpp"
#include "storage/chunk_file.hpp"
#include "storage/records.hpp"

namespace fleetproof {

struct ShardResult {
  CampaignResult runs;          // `stored` counts the runs of published chunks of this shard
  std::uint64_t owned = 0;      // chunks of this shard
  std::uint64_t published = 0;  // of them: all that are published, by whatever session
  bool complete() const { return published == owned; }
};

// What a running shard reports, beside what a campaign does, on the caller's thread.
struct ShardListener {
  CampaignListener campaign;
  std::function<void(const ChunkRange& owned, std::uint64_t published)> planned = [](const auto&, auto) {};
};

// Simulates the chunks of a shard that are not published yet, and publishes each in the folder when it is complete. The
// same plan, program and chunk give the same bytes, whatever shard, machine or session makes it. A stop (a signal,
// deadline) lets the chunks that were begun come to their end. Throws InputError if the folder holds another campaign,
// or one of another program; MachineError if this machine computes differently from the first one, or the disk fails;
// EngineError if a chunk was published with other bytes. Of the options, those that look at results are not used:
// fail_fast, until_verdict, overwrite, allow_drift.
ShardResult run_shard(const CampaignPlan& plan, const AgentPrograms& programs, const ShardFolder& folder, Shard shard,
                      const RunOptions& options, const ShardListener& listener);

// What the chunks of a campaign have in common.
ChunkLabel common_label(const StoredPlan& plan);

// Throws InputError with the reason if the campaign in `where` is not the same as `now`.
void require_same_plan(const std::string& where, const CampaignRecord& stored, const CampaignRecord& now);

}  // namespace fleetproof
