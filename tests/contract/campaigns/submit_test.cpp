// The script for Slurm, given to a stand-in for sbatch that runs each job as Slurm would: with nothing of the caller's
// environment but the variables of Slurm.
#include <gmock/gmock.h>

#include "tests/contract/campaigns/sharded_campaign.hpp"

namespace fleetproof::submit_test {
namespace {

using testing::HasSubstr;

constexpr const char* kSbatch = R"sh(#!/bin/bash
echo "sbatch $*" >> calls.txt
array= wrap= log=
for word; do
  case $word in --array=*) array=${word#*=} ;; --output=*) log=${word#*=} ;; esac
done
wrap=${!#}
tasks() { for part in ${array//,/ }; do seq "${part%-*}" "${part#*-}"; done; }
run() { env -i PATH=/usr/bin:/bin HOME=/nowhere SLURM_JOB_ID=17 "$@" sh -c "$wrap" >> "${log//%?/x}" 2>&1; }
if [ -n "$array" ]; then
  for i in $(tasks); do
    if [ "$i" != "${LOST_TASK-}" ]; then run SLURM_ARRAY_JOB_ID=17 SLURM_ARRAY_TASK_ID="$i"; fi
  done
else
  run A=B
fi
echo 17
)sh";

class Submit : public test::ShardedCampaign {
 protected:
  test::Finished submit(const std::string& words, const std::string& variables = "") const {
    write("sbatch", kSbatch);
    return shell("chmod +x sbatch; " + variables + " PATH=\"$PWD:$PATH\" \"$FLEETPROOF\" submit " + words);
  }
};

TEST_F(Submit, TheJobsLeaveTheFileOfOneMachine) {
  write_campaign("a b.toml", 30);
  write_campaign("c.toml", 30);
  const std::string single = single_file();
  const auto submitted = submit("'a b.toml' --shards 3 --out 'com mon' --db 'm x.db' --cpus 2 --time 90m --go");
  EXPECT_EQ(submitted.exit_code, 0) << submitted.err;
  EXPECT_TRUE(read(path("m x.db")) == single) << read(path("com mon/logs/merge-x.log"));
  const std::string calls = read(path("calls.txt"));
  EXPECT_THAT(calls, HasSubstr("--export=NONE --requeue --open-mode=append --job-name=c --array=1-3"));
  EXPECT_THAT(calls, HasSubstr("--cpus-per-task=2 --time=0-01:30:00 --signal=B:TERM@60"));
  EXPECT_THAT(calls, HasSubstr("--dependency=afterany:17"));
}

TEST_F(Submit, MissingShardsAreSubmittedAgain) {
  write_campaign("c.toml", 400);
  const std::string single = single_file();
  const std::string words = "c.toml --shards 4 --out out --db m.db --go";
  EXPECT_EQ(submit(words, "LOST_TASK=3").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("m.db")));
  EXPECT_EQ(run("missing out --array").out, "3\n");
  EXPECT_EQ(submit(words + " --array \"$(\"$FLEETPROOF\" missing out --array)\"").exit_code, 0);
  EXPECT_TRUE(read(path("m.db")) == single);
}

TEST_F(Submit, WithoutGoItPrintsTheScript) {
  write_campaign("c.toml", 30);
  const auto printed = submit("c.toml --shards 3 --out out --seed 7");
  EXPECT_EQ(printed.exit_code, 0) << printed.err;
  EXPECT_FALSE(std::filesystem::exists(path("calls.txt")));
  EXPECT_THAT(printed.out, HasSubstr("--seed 7 --shard auto --shards 3 --jobs 1"));
  EXPECT_EQ(shell("\"$FLEETPROOF\" submit c.toml --shards 3 --out out | sh -n").exit_code, 0) << "it is a shell script";
}

TEST_F(Submit, RefusesWhatNoJobCouldDo) {
  write_campaign("c.toml", 30);
  write("bad.toml", "horizon_s = 3\n");
  const auto refused = [&](const std::string& words) {
    const auto finished = submit(words);
    EXPECT_EQ(finished.exit_code, 2) << words;
    return finished.err;
  };
  EXPECT_THAT(refused("c.toml --out out"), HasSubstr("--shards: is missing"));
  EXPECT_THAT(refused("c.toml --shards 3"), HasSubstr("--out: is missing"));
  EXPECT_THAT(refused("c.toml --shards 0 --out out"), HasSubstr("--shards: is 0"));
  EXPECT_THAT(refused("c.toml --shards 3 --out out --cpus 0"), HasSubstr("--cpus: is 0"));
  EXPECT_THAT(refused("c.toml --shards 3 --out out --engine lsf"), HasSubstr("--engine: \"lsf\" is not known"));
  EXPECT_THAT(refused("bad.toml --shards 3 --out out"), HasSubstr("bad.toml"));
  for (const char* array : {"0", "4", "2-1", "1,", "1-", "a", "1;rm", "1 2"})
    EXPECT_THAT(refused("c.toml --shards 3 --out out --array '" + std::string(array) + "'"),
                HasSubstr("is no list of shards from 1 to 3, as in 3,7-9"))
        << array;
  // sbatch refuses, and says why.
  write("sbatch", "#!/bin/sh\necho no such partition >&2; exit 1\n");
  const auto failed =
      shell("chmod +x sbatch; PATH=\"$PWD:$PATH\" \"$FLEETPROOF\" submit c.toml --shards 3 --out out --go");
  EXPECT_EQ(failed.exit_code, 3);
  EXPECT_THAT(failed.err, HasSubstr("no such partition"));
}

}  // namespace
}  // namespace fleetproof::submit_test
