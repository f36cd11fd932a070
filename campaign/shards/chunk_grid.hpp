#pragma once

#include <cstdint>

#include "campaign/shards/shard.hpp"

namespace fleetproof {

// Chunks [begin, end) of a grid.
struct ChunkRange {
  std::uint64_t begin = 0, end = 0;
  std::uint64_t count() const { return end - begin; }
};

// The runs of a campaign, cut into chunks of equal length; the last chunk may be shorter. A chunk is what a shard
// publishes at once, and what a stopped shard loses at most. The grid depends on the number of runs alone, not on the
// number of shards.
class ChunkGrid {
 public:
  // A chunk has 4096 runs in campaigns of 2^18 to 2^25 runs. In shorter campaigns it has fewer, down to 16, so that
  // there are 64 chunks or more; in longer ones more, so that there are no more than 8192. Requires: runs is at least
  // 1.
  explicit ChunkGrid(std::uint64_t runs);

  std::uint64_t runs() const { return runs_; }
  std::uint64_t chunk_runs() const { return chunk_runs_; }
  std::uint64_t count() const { return (runs_ + chunk_runs_ - 1) / chunk_runs_; }
  std::uint64_t chunk_of(std::uint64_t run_index) const { return run_index / chunk_runs_; }
  std::uint64_t first_run(std::uint64_t chunk) const { return chunk * chunk_runs_; }
  std::uint64_t run_count(std::uint64_t chunk) const;

  // The neighbouring chunks that a shard simulates. May be empty if there are more shards than chunks.
  ChunkRange of(Shard shard) const;

 private:
  std::uint64_t runs_, chunk_runs_;
};

}  // namespace fleetproof
