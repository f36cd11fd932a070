#include "campaign/shards/slurm_jobs.hpp"

#include <fmt/format.h>

#include <charconv>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof {
namespace {

// As sbatch takes it: days-hours:minutes:seconds.
std::string slurm_time(std::chrono::seconds limit) {
  const auto s = limit.count();
  return fmt::format("{}-{:02}:{:02}:{:02}", s / 86'400, s / 3600 % 24, s / 60 % 60, s % 60);
}

// `exec`: the signal before the time limit goes to this process, and a shell would not pass it on.
std::string shard_command(const ClusterJob& job) {
  return fmt::format("exec {} run {}{}{} --shard auto --shards {} --jobs {} --out {}", shell_word(job.program),
                     shell_word(job.campaign), job.options.empty() ? "" : " ", job.options, job.shards, job.cpus,
                     shell_word(job.out));
}

std::string merge_command(const ClusterJob& job) {
  return fmt::format("exec {} merge {} --db {}", shell_word(job.program), shell_word(job.out), shell_word(job.archive));
}

}  // namespace

std::string slurm_script(const ClusterJob& job) {
  const std::string array = job.array.empty() ? fmt::format("1-{}", job.shards) : job.array;
  const std::string limit = job.limit ? fmt::format("--time={} ", slurm_time(*job.limit)) : "";
  const auto log = [&](const char* name) { return shell_word(job.out + "/logs/" + name); };
  return fmt::format(
      "#!/bin/sh\n"
      "# {} shards of a campaign, and the merge of what they leave.\n"
      "set -eu\n"
      "mkdir -p {}\n"
      "shards=$(sbatch --parsable --export=NONE --requeue --open-mode=append --job-name={} --array={} \\\n"
      "  --cpus-per-task={} {}--signal=B:TERM@60 --output={} \\\n"
      "  --wrap {})\n"
      "sbatch --export=NONE --job-name={} --dependency=afterany:\"${{shards%%;*}}\" --output={} \\\n"
      "  --wrap {}\n",
      job.shards, shell_word(job.out + "/logs"), shell_word(job.name), array, job.cpus, limit, log("shard-%a.log"),
      shell_word(shard_command(job)), shell_word(job.name + " merge"), log("merge-%j.log"),
      shell_word(merge_command(job)));
}

void check_array(const std::string& array, std::uint64_t shards, const std::string& option) {
  const auto refuse = [&] {
    throw InputError(option,
                     fmt::format("{} is no list of shards from 1 to {}, as in 3,7-9", in_quotes(array), shards));
  };
  const char* const end = array.data() + array.size();
  const auto number = [&](const char*& at) {
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || value < 1 || value > shards) refuse();
    at = stop;
    return value;
  };
  for (const char* at = array.data();; ++at) {
    const std::uint64_t first = number(at);
    if (at != end && *at == '-' && number(++at) < first) refuse();
    if (at == end) return;
    if (*at != ',') refuse();
  }
}

}  // namespace fleetproof
