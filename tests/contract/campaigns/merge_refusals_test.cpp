// Merge alone says whether the shards of a campaign are complete, of one plan and program, and undamaged.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/contract/campaigns/sharded_campaign.hpp"

namespace fleetproof::merge_refusals_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class MergeRefusals : public test::ShardedCampaign {
 protected:
  void SetUp() override {
    ShardedCampaign::SetUp();
    write_campaign("c.toml", 40);  // 160 runs: chunks 0 to 9 of 16 runs
    ASSERT_EQ(run_shard("out", "1/1").exit_code, 0);
    ASSERT_EQ(chunk_count("out"), 10U);
  }
  std::string chunk(int number, const std::string& out = "out") const {
    return path(fmt::format("{}/chunks/000/{:06}.chunk", out, number));
  }
  // What merge says. It leaves no file.
  void expect_refused(int exit_code, const std::vector<std::string>& words, const std::string& folders = "out") const {
    const auto refused = run("merge " + folders + " --db m.db");
    EXPECT_EQ(refused.exit_code, exit_code) << refused.err;
    for (const std::string& word : words) EXPECT_THAT(refused.err, HasSubstr(word));
    EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << "one error";
    for (const char* left : {"m.db", "m.db.merging", "m.db.unfinished", "m.sessions.jsonl", "attempts.jsonl"})
      EXPECT_FALSE(fs::exists(path(left))) << left;
  }
  void flip(const std::string& file, std::size_t at) const {
    std::string bytes = read(file);
    ASSERT_LT(at, bytes.size());
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  }
};

TEST_F(MergeRefusals, AGapAndMissingSaysWhatToRunAgain) {
  for (const int number : {2, 6, 7, 9}) fs::remove(chunk(number));
  expect_refused(2, {"4 of 10 chunks are missing: 2, 6-7, 9", "`fleetproof missing`"});
  const auto told = run("missing out --shards 5");
  EXPECT_EQ(told.exit_code, 4);
  EXPECT_THAT(told.out, HasSubstr("4 of 10 chunks are missing: 2, 6-7, 9\n3 of 5 shards to run again: 2, 4-5\n"));
  EXPECT_THAT(told.out, HasSubstr("fleetproof run CAMPAIGN --shard 4/5 --out out\n"));
  EXPECT_THAT(told.out, HasSubstr("sbatch --array=2,4-5 "));
  EXPECT_EQ(run("missing out --shards 5 --array").out, "2,4-5\n");
  EXPECT_EQ(run("missing out --array").out, "1\n") << "there was one shard";
  EXPECT_EQ(nlohmann::json::parse(run("missing out --shards 10 --json").out)["run_again"],
            nlohmann::json({3, 7, 8, 10}));
  for (const char* shard : {"2/5", "4/5", "5/5"}) EXPECT_EQ(run_shard("out", shard).exit_code, 0);
  EXPECT_EQ(run("missing out --array").exit_code, 0);
  EXPECT_EQ(run("missing out --array").out, "\n");
  const std::string single = single_file();
  EXPECT_EQ(merge("out", "m.db"), single_code_);
  EXPECT_TRUE(read(path("m.db")) == single);
}

TEST_F(MergeRefusals, AShardIsRunAgainWithTheSeedOfBefore) {
  ASSERT_EQ(run_shard("other", "1/1", "--seed 6 --replicates 39").exit_code, 0);
  fs::remove(chunk(3, "other"));
  EXPECT_THAT(run("missing other").out,
              HasSubstr("  fleetproof run CAMPAIGN --seed 6 --replicates 39 --shard 1/1 --out other\n"));
}

// A pipe is not waited for.
TEST_F(MergeRefusals, APipeInPlaceOfAChunk) {
  fs::remove(chunk(3));
  ASSERT_EQ(::mkfifo(chunk(3).c_str(), 0644), 0);
  expect_refused(2, {"000003.chunk: this is no regular file"});
  EXPECT_THAT(run("missing out").out, HasSubstr("1 of 10 chunks are missing: 3\n"));
  EXPECT_EQ(run_shard("out", "1/1").exit_code, 2);
}

TEST_F(MergeRefusals, AnOverlap) {
  fs::copy_file(chunk(3), chunk(4), fs::copy_options::overwrite_existing);
  expect_refused(2,
                 {"000004.chunk: this chunk overlaps others: it holds 16 runs from 48 on, and under this name belong "
                  "16 runs from 64 on; move it away"});
  const auto told = run("missing out");
  EXPECT_EQ(told.exit_code, 4);
  EXPECT_THAT(told.err, HasSubstr("this chunk overlaps others"));
  EXPECT_THAT(told.out, HasSubstr("1 of 10 chunks are missing: 4\n"));
}

TEST_F(MergeRefusals, AChunkOfAnotherPlan) {
  ASSERT_EQ(run_shard("other", "1/1", "--seed 6").exit_code, 0);
  fs::copy_file(chunk(3, "other"), chunk(3), fs::copy_options::overwrite_existing);
  expect_refused(2, {"000003.chunk: this chunk belongs to another plan (of the campaign c); move it away"});
  expect_refused(2, {"plan/seed: stored 6, now 5"}, "out other");
}

TEST_F(MergeRefusals, AChunkOfAnotherProgram) {
  ASSERT_EQ(other_program("run c.toml --shard 1/1 --out other").exit_code, 0);
  fs::copy_file(chunk(3, "other"), chunk(3), fs::copy_options::overwrite_existing);
  expect_refused(2, {"000003.chunk: another program made this chunk (fleetproof ", "run it again with the program"});
  expect_refused(2, {"another program made the shards in this folder"}, "out other");
  expect_refused(2, {"another program made these chunks", "merge with that program"}, "other");
}

TEST_F(MergeRefusals, AnIncompleteChunk) {
  const auto size = fs::file_size(chunk(3));
  for (const std::uintmax_t left : {size - 1, size / 2, std::uintmax_t{10}, std::uintmax_t{0}}) {
    fs::resize_file(chunk(3), left);
    expect_refused(3, {"000003.chunk: this chunk is incomplete: it has " + std::to_string(left) + " of ", "remove it"});
  }
  EXPECT_THAT(run("missing out").out, HasSubstr("1 of 10 chunks are missing: 3\n"));
  fs::remove(chunk(3));
  EXPECT_EQ(run_shard("out", "1/1").exit_code, 0) << "the remedy";
  EXPECT_EQ(run("missing out").exit_code, 0);
}

TEST_F(MergeRefusals, AFlippedByte) {
  const auto size = fs::file_size(chunk(3));
  for (const std::size_t at : {std::size_t{12}, std::size_t{30}, size / 2, size - 20, size - 1}) {
    flip(chunk(3), at);
    expect_refused(3, {"000003.chunk: this chunk is damaged: ", "remove it"});
    flip(chunk(3), at);
  }
  merge("out", "m.db");
}

TEST_F(MergeRefusals, ADisagreementOfShards) {
  ASSERT_EQ(run_shard("other", "1/1").exit_code, 0);
  flip(chunk(3, "other"), 300);
  expect_refused(3, {"the same runs ended in two ways", "000003.chunk has other results for them"}, "out other");
  write("out/chunks/000/000005.differs-0123", "as a shard leaves it");
  expect_refused(3, {"000005.differs-0123: a shard computed other results for this chunk"});
}

TEST_F(MergeRefusals, MachinesThatComputeDifferently) {
  ASSERT_EQ(run_shard("other", "1/1").exit_code, 0);
  flip(path("other/canary.txt"), 3);
  expect_refused(3, {"other/canary.txt computes differently"}, "out other");
  write("other/canary.txt", "");
  expect_refused(3, {"other/canary.txt: this file is empty or incomplete; remove it"}, "out other");
  EXPECT_EQ(run_shard("other", "1/1").exit_code, 3);
  fs::remove(path("other/canary.txt"));
  expect_refused(3, {"other/canary.txt: this file is missing; run a shard of this folder again"}, "out other");
  EXPECT_EQ(run_shard("other", "1/1").exit_code, 0) << "the remedy";
  merge("out other", "m.db");
}

TEST_F(MergeRefusals, WhatIsNoFolderOfShards) {
  fs::create_directory(path("empty"));
  expect_refused(2, {"empty: no shard has written a plan.db here"}, "empty");
  expect_refused(2, {"none: there is no such folder"}, "none");
  write("out/chunks/000/notes.txt", "mine");
  expect_refused(2, {"notes.txt: this is not the name of a chunk"});
  fs::remove(path("out/chunks/000/notes.txt"));
  fs::copy_file(chunk(3), chunk(10));
  expect_refused(2, {"000010.chunk: the campaign has the chunks 0 to 9"});
}

TEST_F(MergeRefusals, AnExistingFileStays) {
  write("m.db", "mine");
  EXPECT_EQ(run("merge out --db m.db").exit_code, 2);
  EXPECT_EQ(run("merge out --db m.db --overwrite").exit_code, 2) << "no results file";
  EXPECT_EQ(read(path("m.db")), "mine");
  fs::remove(path("m.db"));
  merge("out", "m.db", "--fail-fast 1");
  EXPECT_EQ(run("merge out --db m.db").exit_code, 2) << "another command made it";
  merge("out", "m.db", "--overwrite");
}

// As a kill leaves it: the file has its name, and the ledger has the begin of the attempt or not even that.
TEST_F(MergeRefusals, AMergeThatWasKilledAfterItsEndCanBeRepeated) {
  const int code = merge("out", "m.db");
  const std::string merged = read(path("m.db")), ledger = read(path("attempts.jsonl"));
  const auto attempts = [&] {
    return nlohmann::json::parse(run("report m.db --format json --exit-zero").out).at("attempts");
  };
  for (const std::string& left : {ledger, ledger.substr(0, ledger.find('\n') + 1), std::string()}) {
    write("attempts.jsonl", left);
    EXPECT_EQ(merge("out", "m.db"), code);
    EXPECT_TRUE(read(path("m.db")) == merged);
    EXPECT_FALSE(fs::exists(path("m.db.again")));
    EXPECT_FALSE(attempts().at("own").at("ended_utc").is_null());
    EXPECT_TRUE(attempts().at("others").empty());
  }
}

TEST_F(MergeRefusals, ADamagedPlan) {
  flip(path("out/plan.db"), read(path("out/plan.db")).find("aisle-grid"));
  expect_refused(3, {"out/plan.db: this plan is damaged; remove it"});
  EXPECT_EQ(run_shard("out", "1/1").exit_code, 3);
  fs::remove(path("out/plan.db"));
  EXPECT_EQ(run_shard("out", "1/1").exit_code, 0) << "the remedy";
  merge("out", "m.db");
}

TEST_F(MergeRefusals, AMergeThatWasKilledCanBeRepeated) {
  const std::string single = single_file();
  write("m.db.merging", "");  // as a kill leaves it
  EXPECT_EQ(merge("out", "m.db"), single_code_);
  EXPECT_TRUE(read(path("m.db")) == single);
  EXPECT_FALSE(fs::exists(path("m.db.merging")));
}

// What was not published does not count.
TEST_F(MergeRefusals, UnfinishedFilesAreIgnored) {
  write("out/chunks/000/.tmp-77-000003.chunk", "half a chunk");
  const std::string single = single_file();
  EXPECT_EQ(merge("out", "m.db"), single_code_);
  EXPECT_TRUE(read(path("m.db")) == single);
}

}  // namespace
}  // namespace fleetproof::merge_refusals_test
