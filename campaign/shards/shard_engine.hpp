#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "campaign/shards/shard.hpp"

namespace fleetproof {

// The value of an environment variable; none if it is not set.
using Environment = std::function<std::optional<std::string>(const std::string& variable)>;

// A shard, and how it was found, in words.
struct ShardChoice {
  Shard shard;
  std::string source;
};

// Finds the shard in the variables that job engines set for their tasks. Exactly one engine must have set all of its
// variables; otherwise this throws InputError: nothing is guessed. `shards`: the number of shards, for engines that do
// not tell it to a task; without it, the variable FLEETPROOF_SHARDS.
ShardChoice find_shard(const Environment& environment, std::optional<std::uint64_t> shards);

}  // namespace fleetproof
