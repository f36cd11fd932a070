#include "campaign/shards/shard_engine.hpp"

#include <gmock/gmock.h>

#include <map>

#include "core/base/error.hpp"

namespace fleetproof::shard_engine_test {
namespace {

using testing::HasSubstr;
using Variables = std::map<std::string, std::string>;

ShardChoice found_in(const Variables& variables, std::optional<std::uint64_t> shards = {}) {
  return find_shard(
      [&](const std::string& name) {
        const auto value = variables.find(name);
        return value == variables.end() ? std::nullopt : std::optional<std::string>(value->second);
      },
      shards);
}

std::string refusal_of(const Variables& variables, std::optional<std::uint64_t> shards = {}) {
  try {
    const ShardChoice choice = found_in(variables, shards);
    return "not refused: " + text_of(choice.shard) + " by " + choice.source;
  } catch (const InputError& error) {
    return error.what();
  }
}

// What an engine sets for the third of eight tasks, as its manual says; `count`: none if it tells no task.
struct Engine {
  Variables third;
  bool tells_count;
};

const std::vector<Engine> kEngines = {
    {{{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "8"}}, true},
    {{{"SLURM_PROCID", "2"}, {"SLURM_NTASKS", "8"}, {"SLURM_STEP_ID", "0"}}, true},
    {{{"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_COUNT", "2"}, {"SLURM_PROCID", "0"}}, false},
    {{{"JOB_COMPLETION_INDEX", "2"}}, false},
    {{{"CI_NODE_INDEX", "3"}, {"CI_NODE_TOTAL", "8"}}, true},
    {{{"CIRCLE_NODE_INDEX", "2"}, {"CIRCLE_NODE_TOTAL", "8"}}, true},
    {{{"BUILDKITE_PARALLEL_JOB", "2"}, {"BUILDKITE_PARALLEL_JOB_COUNT", "8"}}, true},
    {{{"SYSTEM_JOBPOSITIONINPHASE", "3"}, {"SYSTEM_TOTALJOBSINPHASE", "8"}}, true},
    {{{"PBS_ARRAY_INDEX", "3"}}, false},
    {{{"LSB_JOBINDEX", "3"}}, false},
    {{{"SGE_TASK_ID", "3"}}, false},
    {{{"AWS_BATCH_JOB_ARRAY_INDEX", "2"}}, false},
    {{{"NOMAD_ALLOC_INDEX", "2"}}, false},
    {{{"GTEST_SHARD_INDEX", "2"}, {"GTEST_TOTAL_SHARDS", "8"}}, true},
};

TEST(ShardEngine, EveryEngineTellsTheThirdOfEight) {
  for (const auto& [variables, tells_count] : kEngines) {
    const std::string& name = variables.begin()->first;
    const auto count = tells_count ? std::optional<std::uint64_t>() : 8;
    EXPECT_EQ(found_in(variables, count).shard, (Shard{3, 8})) << name;
    EXPECT_EQ(found_in(variables, 8).shard, (Shard{3, 8})) << name;
    Variables with_variable = variables;
    with_variable["FLEETPROOF_SHARDS"] = "8";
    EXPECT_EQ(found_in(with_variable).shard, (Shard{3, 8})) << name;
    EXPECT_THAT(found_in(variables, 8).source, HasSubstr("8")) << name;
  }
}

TEST(ShardEngine, ASetWithoutItsCountIsNotComplete) {
  for (const auto& [variables, tells_count] : kEngines) {
    if (tells_count) continue;
    EXPECT_THAT(refusal_of(variables), HasSubstr("but not the number of shards; give it with --shards N"));
  }
  EXPECT_THAT(refusal_of({{"CI_NODE_INDEX", "3"}}), HasSubstr("CI_NODE_INDEX=3 of GitLab is set, but not the number"));
  EXPECT_EQ(found_in({{"CI_NODE_INDEX", "3"}}, 8).shard, (Shard{3, 8}));
}

TEST(ShardEngine, NoneIsRefused) {
  EXPECT_THAT(refusal_of({}), HasSubstr("no job engine says which shard this is"));
  EXPECT_THAT(refusal_of({}, 8), HasSubstr("SLURM_ARRAY_TASK_ID"));
  EXPECT_THAT(refusal_of({{"FLEETPROOF_SHARDS", "8"}}), HasSubstr("give --shard i/n"));
  EXPECT_THAT(refusal_of({{"CI_NODE_TOTAL", "1"}}), HasSubstr("no job engine")) << "GitLab without `parallel`";
  EXPECT_THAT(refusal_of({{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "8"}}), HasSubstr("no job engine"))
      << "a batch script is no task of a step";
  EXPECT_THAT(refusal_of({{"SGE_TASK_ID", "undefined"}}, 8), HasSubstr("no job engine")) << "no array";
  EXPECT_THAT(refusal_of({{"LSB_JOBINDEX", "0"}}, 8), HasSubstr("no job engine")) << "no array";
  EXPECT_THAT(refusal_of({{"CI_NODE_INDEX", ""}, {"CI_NODE_TOTAL", ""}}), HasSubstr("no job engine")) << "empty";
}

TEST(ShardEngine, TwoAreRefused) {
  for (std::size_t one = 0; one < kEngines.size(); ++one) {
    for (std::size_t other = one + 1; other < kEngines.size(); ++other) {
      Variables both = kEngines[one].third;
      both.insert(kEngines[other].third.begin(), kEngines[other].third.end());
      EXPECT_THAT(refusal_of(both, 8), HasSubstr("2 job engines say which shard this is")) << one << ' ' << other;
    }
  }
}

TEST(ShardEngine, OneCompleteSetBesideAnIncompleteOneIsFound) {
  const Variables in_nomad = {{"CI_NODE_INDEX", "3"}, {"CI_NODE_TOTAL", "8"}, {"NOMAD_ALLOC_INDEX", "0"}};
  EXPECT_EQ(found_in(in_nomad).shard, (Shard{3, 8}));
}

TEST(ShardEngine, IndicesBeyondTheCountAreRefused) {
  EXPECT_THAT(refusal_of({{"SLURM_ARRAY_TASK_ID", "0"}}, 8), HasSubstr("a Slurm array counts from 1 to 8"));
  EXPECT_THAT(refusal_of({{"SLURM_ARRAY_TASK_ID", "9"}}, 8), HasSubstr("a Slurm array counts from 1 to 8"));
  EXPECT_THAT(refusal_of({{"JOB_COMPLETION_INDEX", "8"}}, 8), HasSubstr("counts from 0 to 7"));
  EXPECT_THAT(refusal_of({{"JOB_COMPLETION_INDEX", "0"}}, 0), HasSubstr("at least one shard"));
  EXPECT_THAT(refusal_of({{"JOB_COMPLETION_INDEX", "two"}}, 8), HasSubstr("JOB_COMPLETION_INDEX"));
  EXPECT_THAT(refusal_of({{"JOB_COMPLETION_INDEX", "-1"}}, 8), HasSubstr("whole number"));
  EXPECT_THAT(refusal_of({{"JOB_COMPLETION_INDEX", "2"}, {"FLEETPROOF_SHARDS", "x"}}), HasSubstr("FLEETPROOF_SHARDS"));
}

TEST(ShardEngine, CountsThatDisagreeAreRefused) {
  EXPECT_THAT(refusal_of({{"CI_NODE_INDEX", "3"}, {"CI_NODE_TOTAL", "8"}}, 4), HasSubstr("but --shards 4"));
  EXPECT_THAT(refusal_of({{"SLURM_ARRAY_TASK_ID", "3"}, {"FLEETPROOF_SHARDS", "8"}}, 4), HasSubstr("give one of them"));
}

}  // namespace
}  // namespace fleetproof::shard_engine_test
