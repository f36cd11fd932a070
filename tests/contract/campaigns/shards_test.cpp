// A campaign in shards: in any number, order and number of sessions, the file of one machine, byte for byte.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "storage/archive_reader.hpp"
#include "tests/contract/campaigns/sharded_campaign.hpp"

namespace fleetproof::shards_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class Shards : public test::ShardedCampaign {};

TEST_F(Shards, OneThreeAndEightInAnyOrderAreTheFileOfOneMachine) {
  write_campaign("c.toml", 30);
  const std::string single = single_file();
  const std::vector<std::vector<int>> orders = {{1}, {3, 1, 2}, {5, 2, 8, 1, 7, 3, 6, 4}};
  for (const auto& order : orders) {
    const std::string count = std::to_string(order.size()), out = "out" + count;
    for (const int index : order) {
      const auto shard = run_shard(out, std::to_string(index) + "/" + count, index % 2 == 0 ? "--jobs 1" : "--jobs 3");
      EXPECT_EQ(shard.exit_code, 0) << shard.err;
    }
    EXPECT_EQ(merge(out, "m" + count + ".db"), single_code_);
    EXPECT_TRUE(read(path("m" + count + ".db")) == single) << count;
  }
  // The chunks are the same, too.
  for (const auto& chunk : fs::directory_iterator(folder_ / "out1/chunks/000")) {
    const std::string name = chunk.path().filename();
    EXPECT_TRUE(read(path("out8/chunks/000/" + name)) == read(chunk.path())) << name;
  }
  EXPECT_EQ(run("report m8.db --digest").out, run("report single.db --digest").out);
}

// After 8 replicates of two cells the agent has not passed its audits, so that recordings are kept; after 40 it has.
TEST_F(Shards, PluginsRecordingsAndAuditsAreTheSameToo) {
  fs::copy_file(FLEETPROOF_FAILING_AGENT, path("failing.so"));
  for (const int replicates : {8, 40}) {
    write_campaign("c.toml", replicates, "\"failing.so\", \"reckless\"", "agent_config = \"mixed 20\"\n");
    const std::string single = single_file("--overwrite");
    EXPECT_EQ(ArchiveReader(path("single.db")).recording_count("failing") > 0, replicates == 8);
    const std::string out = "out" + std::to_string(replicates);
    for (const char* shard : {"2/3", "3/3", "1/3"}) EXPECT_EQ(run_shard(out, shard).exit_code, 0);
    EXPECT_EQ(merge(out, "m.db", "--overwrite"), single_code_);
    EXPECT_TRUE(read(path("m.db")) == single) << replicates;
    EXPECT_EQ(run("replay m.db 0").exit_code, 0) << "the plug-in is remembered";
  }
}

TEST_F(Shards, AKilledShardGoesOnWithItsNextChunk) {
  write_campaign("c.toml", 2000);
  const std::string single = single_file();
  for (std::size_t round = 1; round <= 5; ++round) {  // each time after some more chunks
    shell(
        fmt::format("\"$FLEETPROOF\" run c.toml --shard 1/2 --out out & pid=$!\n"
                    "until [ $(ls out/chunks/000 2>/dev/null | wc -l) -ge {} ]; do sleep 0.01; done\n"
                    "kill -9 $pid; wait $pid",
                    6 * round));
    EXPECT_GT(chunk_count("out"), 5 * round - 5) << "it went on where it was killed";
    ASSERT_LT(chunk_count("out"), 62U) << "a kill struck before the last chunk";
  }
  const std::size_t before = chunk_count("out");
  const auto resumed = run_shard("out", "1/2");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("; " + std::to_string(before) + " of them are published already"));
  EXPECT_EQ(run_shard("out", "2/2").exit_code, 0);
  EXPECT_EQ(merge("out", "m.db"), single_code_);
  EXPECT_TRUE(read(path("m.db")) == single);
}

TEST_F(Shards, AStopLetsTheChunksThatWereBegunComeToTheirEnd) {
  write_campaign("c.toml", 4000);
  const auto stopped = shell(
      "\"$FLEETPROOF\" run c.toml --shard 1/1 --out out & pid=$!\n"
      "until ls out/chunks/000/*.chunk >/dev/null 2>&1; do sleep 0.02; done; kill -TERM $pid; wait $pid");
  EXPECT_EQ(stopped.exit_code, 143) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("interrupted: go on: fleetproof run c.toml --shard 1/1 --out out"));
  const auto missing = run("missing out --json");
  EXPECT_EQ(missing.exit_code, 4);
  const auto json = nlohmann::json::parse(missing.out);
  EXPECT_GT(json["missing"].size(), 0U);
  EXPECT_EQ(json["missing"].size() + chunk_count("out"), json["chunks"]);
  EXPECT_EQ(json["run_again"], nlohmann::json({1}));
  const auto log = session_lines("out");
  EXPECT_THAT(log, HasSubstr("\"runs_simulated\":" +
                             std::to_string(chunk_count("out") * json["chunk_runs"].get<std::size_t>()) + ","))
      << "no run was simulated in vain";
  EXPECT_EQ(run_shard("out", "1/1", "--max-time 1h").exit_code, 0);
  EXPECT_EQ(run("missing out").exit_code, 0);
}

TEST_F(Shards, TwoProgramsMayDoTheSameShardAtOnce) {
  write_campaign("c.toml", 400);
  const std::string single = single_file();
  const auto both = shell(
      "\"$FLEETPROOF\" run c.toml --shard 1/1 --out out & one=$!\n\"$FLEETPROOF\" run c.toml --shard 1/1 --out out & "
      "two=$!\n\"$FLEETPROOF\" run c.toml --shard 1/2 --out out; three=$?; wait $one; one=$?; wait $two; echo $one $? "
      "$three");
  EXPECT_THAT(both.out, HasSubstr("0 0 0\n")) << both.err;
  EXPECT_EQ(merge("out", "m.db"), single_code_);
  EXPECT_TRUE(read(path("m.db")) == single);
}

// A node that was given up comes back when another one has done its work.
TEST_F(Shards, AnOrphanThatFinishesLateChangesNothing) {
  write_campaign("c.toml", 1000);
  const std::string single = single_file();
  const auto orphan = shell(
      "\"$FLEETPROOF\" run c.toml --shard 1/1 --out out 2>orphan.txt & pid=$!\n"
      "until [ $(ls out/chunks/000 2>/dev/null | wc -l) -ge 3 ]; do sleep 0.01; done\n"
      "kill -STOP $pid; ls out/chunks/000 | wc -l; \"$FLEETPROOF\" run c.toml --shard 1/1 --out out; "
      "sha256sum out/chunks/000/* >before; kill -CONT $pid; wait $pid; echo orphan $?; sha256sum -c --quiet before");
  EXPECT_EQ(orphan.exit_code, 0) << "no chunk was replaced" << orphan.err;
  EXPECT_THAT(orphan.out, HasSubstr("orphan 0\n"));
  EXPECT_LT(std::stoi(orphan.out), 60) << "the orphan was stopped before its end";
  EXPECT_EQ(merge("out", "m.db"), single_code_);
  EXPECT_TRUE(read(path("m.db")) == single);
}

TEST_F(Shards, MergeStopsWhereOneMachineStops) {
  write_campaign("c.toml", 200);
  const std::string fail_fast = single_file("--fail-fast 5");
  fs::remove(path("single.db"));
  const std::string until_verdict = single_file("--until-verdict");
  EXPECT_NE(until_verdict, fail_fast);
  for (const char* shard : {"1/4", "2/4"}) EXPECT_EQ(run_shard("out", shard).exit_code, 0);
  EXPECT_EQ(run("merge out --db m.db").exit_code, 2) << "half of the chunks are missing";
  EXPECT_EQ(merge("out", "m.db", "--until-verdict"), 1);
  EXPECT_TRUE(read(path("m.db")) == until_verdict) << "what is missing comes after the verdict";
  EXPECT_EQ(merge("out", "m.db", "--fail-fast 5 --overwrite"), 1);
  EXPECT_TRUE(read(path("m.db")) == fail_fast);
  EXPECT_EQ(run("merge out --db m.db --fail-fast 100000 --overwrite").exit_code, 2) << "these may need what is missing";
}

TEST_F(Shards, FoldersOfMachinesWithoutACommonDiskAreMergedToo) {
  write_campaign("c.toml", 20);
  const std::string single = single_file();
  EXPECT_EQ(run_shard("a", "1/2").exit_code, 0);
  EXPECT_EQ(run_shard("b", "2/2").exit_code, 0);
  EXPECT_EQ(run_shard("c", "2/3").exit_code, 0);
  EXPECT_EQ(run("merge a --db m.db").exit_code, 2);
  EXPECT_EQ(merge("a b c", "m.db"), single_code_) << "what two folders have is the same";
  EXPECT_TRUE(read(path("m.db")) == single);
}

TEST_F(Shards, AFullDiskPublishesNothingHalf) {
  write_campaign("c.toml", 40);
  EXPECT_EQ(run_shard("out", "1/2").exit_code, 0);
  const auto full = shell("ulimit -f 5; \"$FLEETPROOF\" run c.toml --shard 2/2 --out out");
  EXPECT_EQ(full.exit_code, 3);
  EXPECT_THAT(full.err, HasSubstr("free some space"));
  EXPECT_EQ(chunk_count("out"), 5U) << "of the first shard";
  for (const auto& file : fs::recursive_directory_iterator(folder_ / "out/chunks"))
    EXPECT_FALSE(file.path().filename().string().starts_with(".tmp")) << file.path();
  EXPECT_EQ(run_shard("out", "2/2").exit_code, 0);
  EXPECT_EQ(run("missing out").exit_code, 0);
}

TEST_F(Shards, SessionsSayWhichMachinesTookPart) {
  write_campaign("c.toml", 20);
  const auto shard =
      shell("SLURM_ARRAY_TASK_ID=1 FLEETPROOF_SHARDS=1 \"$FLEETPROOF\" run c.toml --shard auto --out out");
  EXPECT_EQ(shard.exit_code, 0) << shard.err;
  EXPECT_THAT(shard.err, HasSubstr("shard 1/1 (a Slurm array: SLURM_ARRAY_TASK_ID=1, FLEETPROOF_SHARDS=1)"));
  merge("out", "m.db");
  std::ifstream log(path("m.sessions.jsonl"));
  std::string line;
  ASSERT_TRUE(std::getline(log, line));
  const auto first = nlohmann::json::parse(line);
  EXPECT_EQ(first["shard"], "1/1");
  EXPECT_THAT(first["shard_source"].get<std::string>(), HasSubstr("SLURM_ARRAY_TASK_ID=1"));
  EXPECT_THAT(first["libraries"].get<std::string>(), HasSubstr("glibc "));
  EXPECT_TRUE(first.contains("cpu"));
}

TEST_F(Shards, WhatAShardDoesNotDoIsRefusedByName) {
  write_campaign("c.toml", 20);
  for (const std::string option : {"--db x.db", "--until-verdict", "--fail-fast 3", "--findings f.toml", "--ledger l",
                                   "--overwrite", "--allow-drift", "--exit-zero", "--json"}) {
    const auto refused = run("run c.toml --shard 1/2 --out out " + option);
    EXPECT_EQ(refused.exit_code, 2) << option;
    EXPECT_THAT(refused.err, HasSubstr("error: " + option.substr(0, option.find(' ')) + ": ")) << option;
    EXPECT_THAT(refused.err, HasSubstr("cannot stand beside --shard")) << option;
  }
  for (const std::string words : {"--shard 1/2", "--out out", "--shards 2", "--shard 3/2 --out out",
                                  "--shard 1/2 --shards 3 --out out", "--shard auto --out out"})
    EXPECT_EQ(run("run c.toml " + words).exit_code, 2) << words;
  EXPECT_EQ(shell("CI_NODE_INDEX=1 CI_NODE_TOTAL=2 GTEST_SHARD_INDEX=0 GTEST_TOTAL_SHARDS=2 \"$FLEETPROOF\" run c.toml "
                  "--shard auto --out out")
                .exit_code,
            2);
  EXPECT_FALSE(fs::exists(path("out"))) << "nothing was written";
}

TEST_F(Shards, AnotherCampaignOrProgramIsRefusedBeforeItSimulates) {
  write_campaign("c.toml", 20);
  EXPECT_EQ(run_shard("out", "1/2").exit_code, 0);
  auto refused = run_shard("out", "2/2", "--seed 6");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("belong to another campaign (plan/seed: stored 5, now 6); name another folder"));
  refused = run_shard("out", "2/2", "--replicates 21");
  EXPECT_THAT(refused.err, HasSubstr("plan/replicates: stored 20, now 21"));
  refused = other_program("run c.toml --shard 2/2 --out out");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("another program made the shards in this folder (program sha256: stored "));
  EXPECT_EQ(chunk_count("out"), 2U) << "of the first shard";
}

TEST_F(Shards, AMachineThatComputesDifferentlyRefusesItself) {
  fs::copy_file(FLEETPROOF_FAILING_AGENT, path("failing.so"));
  write_campaign("c.toml", 20, "\"failing.so\"", "agent_config = \"none 1\"\n");
  EXPECT_EQ(run_shard("out", "1/2").exit_code, 0);
  const std::size_t before = chunk_count("out");
  auto refused = shell("FLEETPROOF_TEST_REBUILT=yes \"$FLEETPROOF\" run c.toml --shard 2/2 --out out");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("error: out/canary.txt: this machine computes differently"));
  std::string canary = read(path("out/canary.txt"));
  canary[0] = canary[0] == '0' ? '1' : '0';  // the reference agent, in the same worlds
  write("out/canary.txt", canary);
  refused = run_shard("out", "2/2");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("this machine computes differently"));
  EXPECT_THAT(refused.err, HasSubstr("hull-lock"));
  EXPECT_EQ(chunk_count("out"), before) << "it published nothing";
}

}  // namespace
}  // namespace fleetproof::shards_test
