#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "campaign/batch/campaign.hpp"
#include "campaign/cli/command_line.hpp"
#include "campaign/plan/campaign_file.hpp"
#include "campaign/run/agent_programs.hpp"

namespace fleetproof::cli {

// The options of `run` that make it simulate one shard of a campaign.
struct ShardWords {
  std::string shard, out;
  std::optional<std::uint64_t> shards;
  bool given() const { return !shard.empty() || !out.empty() || shards.has_value(); }
};

void add_shard_options(Options& options, ShardWords& words);

// What `run` knows when it has read its words.
struct ShardCall {
  const CampaignFile& file;
  const AgentPrograms& programs;
  RunOptions options;
  std::string overrides;       // the options that change the plan, as typed
  std::string resume_command;  // without the options of the shard
  bool fresh_seed = false;
  std::function<bool()> wants_status;
};

// Simulates the shard. Returns 0 if all of its chunks are published, 128 + signal if it was interrupted before, 4 if
// its time was over before. Throws InputError if the words name no shard or no folder.
int simulate_shard(const ShardWords& words, const ShardCall& call);

}  // namespace fleetproof::cli
