#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "campaign/batch/audit_queue.hpp"
#include "campaign/shards/chunk_grid.hpp"
#include "campaign/shards/run_spool.hpp"
#include "campaign/shards/shard_folder.hpp"
#include "storage/chunk_file.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// Collects the runs of a shard and publishes each chunk as soon as all of its runs and audits are there. Threads: one.
class ChunkCollector {
 public:
  // `label`: what all chunks of the campaign have in common.
  ChunkCollector(ShardFolder folder, const ChunkGrid& grid, ChunkLabel label);

  // `audited`: the run's audit will follow.
  void add(const RunRecord& run, bool audited);
  void add(const AuditRecord& audit);
  // No more audits are waited for; those that follow nevertheless are dropped.
  void audits_end();
  // A chunk waits for nothing but audits.
  bool waits_for_audits() const;
  // Runs that are not published yet.
  std::uint64_t open_runs() const;
  // Publishes the chunks that are complete. Throws EngineError if other bytes were published for one of them; its own
  // bytes are then kept beside it. Throws MachineError if the disk fails.
  void publish();

  std::uint64_t published() const { return published_; }  // by this queue, or found with the same bytes

 private:
  struct OpenChunk {
    explicit OpenChunk(std::uint64_t length) : runs(length) {}
    RunSpool runs;
    std::uint64_t finished = 0, audits_open = 0;
    std::vector<AuditRecord> audits;
  };

  void publish(std::uint64_t chunk, const OpenChunk& open);

  ShardFolder folder_;
  const ChunkGrid& grid_;
  ChunkLabel label_;
  std::map<std::uint64_t, OpenChunk> open_;
  std::uint64_t published_ = 0;
};

}  // namespace fleetproof
