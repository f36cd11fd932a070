#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "campaign/shards/shard.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// The folder that the shards of a campaign share. No file in it is ever changed: each appears whole under its name
// (storage/durable_file.hpp), or belongs to one session alone.
//   plan.db                    the campaign without runs: plan, cells, gates, program
//   canary.txt                 what fixed runs come out as
//   chunks/000/000012.chunk    the runs of chunk 12
//   sessions/                  who simulated what, where and when
class ShardFolder {
 public:
  explicit ShardFolder(std::string path) : path_(std::move(path)) {}

  const std::string& path() const { return path_; }
  std::string plan_file() const { return path_ + "/plan.db"; }
  std::string canary_file() const { return path_ + "/canary.txt"; }
  std::string chunk_file(std::uint64_t chunk) const;
  // Where bytes are kept that differ from a chunk which was published before.
  std::string differing_file(std::uint64_t chunk) const;
  // A name for a new file that will get the name `target`.
  static std::string temporary_name(const std::string& target);
  // A new name; a session log (campaign/batch/session_log.hpp) stands beside a file of this name.
  std::string new_session_name(Shard shard) const;

  // Makes the folder and those in it. Throws InputError if that is not possible.
  void make() const;
  // Throws InputError if there is no such folder with a plan.
  void require_plan() const;
  // Throws InputError for a file in the folder of the chunks that is none.
  std::map<std::uint64_t, std::string> chunk_files() const;
  std::vector<std::string> differing_files() const;
  std::vector<std::string> sessions() const;  // the names of all sessions, in their order

 private:
  std::string path_;
};

// The campaign of a folder of shards, as its plan.db holds it: a results file without runs. SQLite locks the files
// that it opens, which a network disk may not be able to; so both work on copies in the local folder for temporary
// files ($TMPDIR).
// Throws InputError if there is no plan, EngineError if it is damaged, MachineError if the disk fails.
StoredPlan read_plan(const ShardFolder& folder);
// Writes the plan, unless there is one. Its bytes are the same on every machine. Throws MachineError if the disk fails.
void publish_plan(const ShardFolder& folder, const StoredPlan& plan);

}  // namespace fleetproof
