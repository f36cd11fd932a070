#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "campaign/batch/time_budget.hpp"
#include "campaign/cli/archive_name.hpp"
#include "campaign/cli/campaign_words.hpp"
#include "campaign/cli/streams.hpp"
#include "campaign/cli/verbs.hpp"
#include "campaign/shards/shard.hpp"
#include "campaign/shards/slurm_jobs.hpp"
#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "storage/target_file.hpp"

namespace fleetproof::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostCpus = 1024;

struct SubmitWords {
  std::string campaign, engine = "slurm", out, archive, time, array;
  std::optional<std::uint64_t> shards, cpus, replicates, seed;
  bool go = false;
};

std::string absolute(const std::string& path) { return fs::path(absolute_name(path)).lexically_normal().string(); }

ClusterJob job_of(const SubmitWords& words, const std::string& campaign_name) {
  ClusterJob job;
  job.program = fs::read_symlink("/proc/self/exe").string();
  job.campaign = absolute(words.campaign);
  job.out = absolute(words.out);
  job.archive = absolute(words.archive.empty() ? archive_name_of(campaign_name) : words.archive);
  job.name = campaign_name;
  if (words.seed) job.options += fmt::format("--seed {} ", *words.seed);
  if (words.replicates) job.options += fmt::format("--replicates {} ", *words.replicates);
  if (!job.options.empty()) job.options.pop_back();
  job.shards = words.shards.value();
  job.cpus = words.cpus.value_or(1);
  if (!words.time.empty()) job.limit = duration_of(words.time, "--time");
  job.array = words.array;
  return job;
}

// Gives the script to the shell, which says what sbatch says.
int hand_over(const std::string& script) {
  std::FILE* const shell = ::popen("sh", "w");
  if (shell == nullptr) throw MachineError("sh: cannot be started; run the script yourself: leave out --go");
  const bool given = std::fwrite(script.data(), 1, script.size(), shell) == script.size();
  if (::pclose(shell) != 0 || !given)
    throw MachineError("sbatch: did not take the jobs (its own words stand above); leave out --go to see the script");
  return kDemonstrated;
}

int submit(const SubmitWords& words) {
  if (words.engine != "slurm")
    throw InputError("--engine", fmt::format("{} is not known; known: slurm. For others see tests/examples/cluster",
                                             in_quotes(words.engine)));
  if (words.out.empty()) throw InputError("--out", "is missing: the folder on a common disk that all shards write to");
  if (!words.shards) throw InputError("--shards", "is missing: into how many tasks the campaign is divided");
  if (*words.shards < 1 || *words.shards > kMostShards)
    throw InputError("--shards", fmt::format("is {}; it lies between 1 and {}", *words.shards, kMostShards));
  if (words.cpus && (*words.cpus < 1 || *words.cpus > kMostCpus))
    throw InputError("--cpus", fmt::format("is {}; it lies between 1 and {}", *words.cpus, kMostCpus));
  if (!words.array.empty()) check_array(words.array, *words.shards, "--array");
  AgentPrograms programs;
  const CampaignFile file =
      load_campaign(words.campaign, programs);  // what is wrong with it is said now, not by a task
  const std::string script = slurm_script(job_of(words, file.plan.name));
  if (words.go) return hand_over(script);
  put_text(script);
  return kDemonstrated;
}

}  // namespace

Action prepare_submit(Options& options) {
  auto words = std::make_shared<SubmitWords>();
  options.positional("CAMPAIGN", words->campaign, "campaign file (TOML), on a disk that all nodes have");
  options.option("--engine", words->engine, "the job engine (default: slurm)");
  options.option("--shards", words->shards, "number of tasks");
  options.option("--out", words->out, "folder that all shards write to, on that disk");
  options.option("--db", words->archive, "results file that the merge writes (default: the campaign's name and .db)");
  options.option("--cpus", words->cpus, "cores of each task (default: 1)");
  options.option("--time", words->time, "time limit of each task, as in 45m or 5h30m (default: that of the partition)");
  options.option("--array", words->array, "only these shards, as `fleetproof missing DIR --array` prints them");
  options.option("--replicates", words->replicates, "instead of the file's number of replicates");
  options.option("--seed", words->seed, "instead of the file's seed");
  options.flag("--go", words->go, "give the jobs to the engine; without it, print the script");
  return [words] { return submit(*words); };
}

}  // namespace fleetproof::cli
