#include "campaign/shards/shard_engine.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

constexpr const char* kShardsVariable = "FLEETPROOF_SHARDS";

// How an engine numbers the tasks of a job. `count` empty: it tells no task how many there are.
struct ShardEngine {
  std::string_view name, index, count;
  std::uint64_t first;          // the index of the first task
  std::string_view needs = {};  // a variable that must be set, too
};

// SLURM_PROCID is also set in a batch script, where it is no task of a step.
constexpr auto kEngines = std::to_array<ShardEngine>({
    {"Open MPI", "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", 0},
    {"srun", "SLURM_PROCID", "SLURM_NTASKS", 0, "SLURM_STEP_ID"},
    {"a Slurm array", "SLURM_ARRAY_TASK_ID", "", 1},
    {"a Kubernetes indexed job", "JOB_COMPLETION_INDEX", "", 0},
    {"GitLab", "CI_NODE_INDEX", "CI_NODE_TOTAL", 1},
    {"CircleCI", "CIRCLE_NODE_INDEX", "CIRCLE_NODE_TOTAL", 0},
    {"Buildkite", "BUILDKITE_PARALLEL_JOB", "BUILDKITE_PARALLEL_JOB_COUNT", 0},
    {"Azure Pipelines", "SYSTEM_JOBPOSITIONINPHASE", "SYSTEM_TOTALJOBSINPHASE", 1},
    {"a PBS array", "PBS_ARRAY_INDEX", "", 1},
    {"an LSF array", "LSB_JOBINDEX", "", 1},
    {"a Grid Engine array", "SGE_TASK_ID", "", 1},
    {"an AWS Batch array", "AWS_BATCH_JOB_ARRAY_INDEX", "", 0},
    {"Nomad", "NOMAD_ALLOC_INDEX", "", 0},
    {"a test sharder", "GTEST_SHARD_INDEX", "GTEST_TOTAL_SHARDS", 0},
});

// What the environment holds of one engine.
struct Found {
  const ShardEngine* engine = nullptr;
  std::string index, count;  // as the variables say it; empty: not set
};

// LSF sets 0 and Grid Engine "undefined" for a job that is no array.
bool is_of_an_array(const ShardEngine& engine, const std::string& index) {
  if (engine.index == "LSB_JOBINDEX") return index != "0";
  return engine.index != "SGE_TASK_ID" || index != "undefined";
}

std::vector<Found> found_in(const Environment& environment) {
  std::vector<Found> all;
  for (const ShardEngine& engine : kEngines) {
    const auto value_of = [&](std::string_view variable) {
      return variable.empty() ? "" : environment(std::string(variable)).value_or("");
    };
    const std::string index = value_of(engine.index);
    if (index.empty() || !is_of_an_array(engine, index)) continue;
    if (!engine.needs.empty() && value_of(engine.needs).empty()) continue;
    all.push_back({&engine, index, value_of(engine.count)});
  }
  return all;
}

// The number of shards that the user gives.
struct GivenCount {
  std::uint64_t count = 0;
  std::string source;
};

std::optional<GivenCount> given_count(const Environment& environment, std::optional<std::uint64_t> shards) {
  const std::string variable = environment(kShardsVariable).value_or("");
  if (variable.empty() && !shards) return std::nullopt;
  if (variable.empty()) return GivenCount{*shards, fmt::format("--shards {}", *shards)};
  const std::uint64_t count = parse_count(variable, kShardsVariable);
  if (shards && *shards != count)
    throw InputError("--shards", fmt::format("is {}, and {} is {}; give one of them", *shards, kShardsVariable, count));
  return GivenCount{count, fmt::format("{}={}", kShardsVariable, count)};
}

ShardChoice choice_of(const Found& found, const std::optional<GivenCount>& given) {
  const ShardEngine& engine = *found.engine;
  const std::uint64_t index = parse_count(found.index, engine.index);
  ShardChoice choice;
  choice.source = fmt::format("{}: {}={}", engine.name, engine.index, index);
  if (!found.count.empty()) {
    choice.shard.count = parse_count(found.count, engine.count);
    choice.source += fmt::format(", {}={}", engine.count, choice.shard.count);
    if (given && given->count != choice.shard.count)
      throw InputError("--shard auto", fmt::format("{}, but {}; leave one of them out", choice.source, given->source));
  } else {
    choice.shard.count = given->count;
    choice.source += ", " + given->source;
  }
  if (choice.shard.count < 1)
    throw InputError("--shard auto", fmt::format("{}: there is at least one shard", choice.source));
  if (index < engine.first || index - engine.first >= choice.shard.count) {
    throw InputError("--shard auto",
                     fmt::format("{}: {} counts from {} to {}; submit with these numbers, or give --shard i/n",
                                 choice.source, engine.name, engine.first, engine.first + choice.shard.count - 1));
  }
  choice.shard.index = index - engine.first + 1;
  return choice;
}

[[noreturn]] void throw_none(const std::vector<Found>& incomplete) {
  if (incomplete.empty()) {
    std::string names;
    for (const ShardEngine& engine : kEngines) names += fmt::format("{}{}", names.empty() ? "" : ", ", engine.index);
    throw InputError(
        "--shard auto",
        fmt::format("no job engine says which shard this is (none of {} is set); give --shard i/n", names));
  }
  std::string sentence;
  for (const Found& found : incomplete)
    sentence += fmt::format("{}{}={} of {}", sentence.empty() ? "" : ", ", found.engine->index, found.index,
                            found.engine->name);
  throw InputError("--shard auto",
                   fmt::format("{} {} set, but not the number of shards; give it with --shards N or in {}", sentence,
                               incomplete.size() == 1 ? "is" : "are", kShardsVariable));
}

}  // namespace

ShardChoice find_shard(const Environment& environment, std::optional<std::uint64_t> shards) {
  const auto given = given_count(environment, shards);
  std::vector<Found> complete, incomplete;
  for (const Found& found : found_in(environment)) {
    const bool has_count = !found.count.empty() || given;
    (has_count ? complete : incomplete).push_back(found);
  }
  if (complete.empty()) throw_none(incomplete);
  if (complete.size() > 1) {
    std::string names;
    for (const Found& found : complete)
      names +=
          fmt::format("{}{} ({}={})", names.empty() ? "" : ", ", found.engine->name, found.engine->index, found.index);
    throw InputError("--shard auto", fmt::format("{} job engines say which shard this is: {}; give --shard i/n",
                                                 complete.size(), names));
  }
  return choice_of(complete.front(), given);
}

}  // namespace fleetproof
