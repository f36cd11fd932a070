#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaign/shards/chunk_grid.hpp"
#include "campaign/shards/shard_folder.hpp"
#include "storage/chunk_file.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// The published chunks of one campaign, in one folder or several: shards without a common disk have one each.
class PublishedChunks {
 public:
  // Throws InputError if a folder holds no campaign, if the folders hold different ones or those of another program, or
  // if a file is where it does not belong; MachineError if their canaries differ; EngineError if shards disagreed about
  // a chunk. Requires: there is at least one folder.
  explicit PublishedChunks(const std::vector<std::string>& folders);

  const StoredPlan& plan() const { return plan_; }
  const CampaignRecord& campaign() const { return plan_.campaign; }
  const ChunkGrid& grid() const { return grid_; }
  // Chunks that no folder has, in their order.
  std::vector<std::uint64_t> missing() const;
  // Published chunks that cannot be put together with the others, with the reason. Reads their heads only.
  std::map<std::uint64_t, std::string> unusable() const;
  // Hands over the runs of a chunk, in order, then its audits. Throws InputError if the chunk belongs to another plan,
  // program or place; EngineError if it is incomplete or damaged.
  void read(std::uint64_t chunk, const std::function<void(const RunRecord&)>& run,
            const std::function<void(const AuditRecord&)>& audit) const;
  // The names of all sessions (campaign/batch/session_log.hpp).
  std::vector<std::string> sessions() const;

 private:
  void require_one_campaign() const;
  void find_chunks(const ShardFolder& folder);
  ChunkFile opened(std::uint64_t chunk) const;

  std::vector<ShardFolder> folders_;
  StoredPlan plan_;
  ChunkGrid grid_;
  std::map<std::uint64_t, std::string> files_;  // by chunk
};

struct MergeOptions {
  bool overwrite = false;                   // replace an existing results file
  bool until_verdict = false;               // keep the runs up to the verdict, as `run` does
  std::uint64_t fail_fast = 0;              // keep the runs up to so many failed ones; 0: all
  std::optional<Keep> keep;                 // instead of that of the shards
  std::function<void()> publishes = [] {};  // all is read: before the file gets its name, or it is there already
  std::function<void(std::uint64_t chunks)> tick = [](std::uint64_t) {};  // so many have been read
};

// Puts the chunks together to the results file that one machine would have written, byte for byte, and returns the
// number of its runs. Throws InputError if a chunk is missing that is needed, or if another program made it, and what
// `read` and ArchiveWriter throw; then `path` is as it was. If the file is there already with these bytes, all is well.
std::uint64_t merge_chunks(const PublishedChunks& chunks, const std::string& path, const MergeOptions& options);

// "3, 12-18": numbers in ascending order.
std::string ranges_text(const std::vector<std::uint64_t>& numbers, const std::string& separator = ", ");

}  // namespace fleetproof
