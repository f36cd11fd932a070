#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace fleetproof {

// A campaign for a cluster. All paths are those of a disk that every node has.
struct ClusterJob {
  std::string program, campaign, out, archive, name;
  std::string options;  // of `run`, as typed
  std::uint64_t shards = 0;
  std::uint64_t cpus = 1;                     // of one shard
  std::optional<std::chrono::seconds> limit;  // of one shard; none: that of the partition
  std::string array;                          // of shards, as in "3,7-9"; empty: all
};

// A shell script that gives the shards to Slurm as an array, and the merge as a job after it. Slurm starts a task again
// if its node fails. A minute before the time limit it asks the task to stop. The merge follows whatever Slurm says of
// the tasks (afterany): it alone decides whether all is there. Nothing of the caller's environment goes with the jobs.
std::string slurm_script(const ClusterJob& job);

// Throws InputError at `option` if the list is not as in "3,7-9", or names a shard that does not exist.
void check_array(const std::string& array, std::uint64_t shards, const std::string& option);

}  // namespace fleetproof
