#include "campaign/shards/chunk_grid.hpp"

#include <algorithm>
#include <bit>

#include "core/base/error.hpp"
#include "storage/records.hpp"

namespace fleetproof {
namespace {

constexpr std::uint64_t kFewestChunks = 64, kMostChunks = 4096, kShortestChunk = 16;

std::uint64_t chunk_runs_of(std::uint64_t runs) {
  const std::uint64_t short_enough =
      std::max(kShortestChunk, std::bit_floor(std::max<std::uint64_t>(1, runs / kFewestChunks)));
  return std::max(std::min(kChunkRuns, short_enough), std::bit_floor(runs / kMostChunks));
}

}  // namespace

ChunkGrid::ChunkGrid(std::uint64_t runs) : runs_(runs), chunk_runs_(chunk_runs_of(runs)) {
  ensure(runs >= 1, "a campaign has at least one run");
}

std::uint64_t ChunkGrid::run_count(std::uint64_t chunk) const {
  return std::min(chunk_runs_, runs_ - first_run(chunk));
}

ChunkRange ChunkGrid::of(Shard shard) const {
  const auto border = [&](std::uint64_t index) { return count() * index / shard.count; };
  return {border(shard.index - 1), border(shard.index)};
}

}  // namespace fleetproof
