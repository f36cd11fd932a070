// keep = "failing": a results file without rows of the runs in which nothing went wrong, and with the same pages.
#include <gmock/gmock.h>

#include <filesystem>

#include "storage/archive_reader.hpp"
#include "tests/contract/campaigns/sharded_campaign.hpp"

namespace fleetproof::keep_failing_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class KeepFailing : public test::ShardedCampaign {
 protected:
  // The first run that was folded.
  std::string folded_run(const std::string& archive) const {
    const ArchiveReader reader(path(archive));
    for (std::uint64_t run = 0; run < reader.run_count(); ++run) {
      if (reader.folded_run(run)) return std::to_string(run);
    }
    ADD_FAILURE() << "no run is folded";
    return "0";
  }
  // What the program writes of an archive, which had this name.
  std::string page(const std::string& archive, const std::string& format) {
    std::filesystem::copy_file(path(archive), path("x.db"), std::filesystem::copy_options::overwrite_existing);
    if (format != "html") return run("report x.db --exit-zero --format " + format).out;
    EXPECT_EQ(run("report x.db --exit-zero --html x.html").exit_code, 0);
    return read(path("x.html"));
  }
};

TEST_F(KeepFailing, GivesTheSamePagesFromALittleFile) {
  // "reckless" sends no message: if it were under test, such runs would keep their rows.
  const std::string agents =
      "{ agent = \"hull-lock\", role = \"candidate\" }, { agent = \"reckless\", role = \"reference\" }";
  write_campaign("c.toml", 300, agents);
  write_campaign("f.toml", 300, agents, "keep = \"failing\"\n");
  const auto all = run("run c.toml --db all.db"), failing = run("run f.toml --db failing.db --jobs 3");
  EXPECT_EQ(all.exit_code, failing.exit_code) << failing.err;
  for (const char* format : {"text", "json", "markdown", "junit", "summary", "html"})
    EXPECT_EQ(page("failing.db", format), page("all.db", format)) << format;
  EXPECT_EQ(run("report failing.db --digest").out, run("report all.db --digest").out);
  EXPECT_LT(2 * std::filesystem::file_size(path("failing.db")), std::filesystem::file_size(path("all.db")));
}

TEST_F(KeepFailing, AnyRunCanBeSimulatedAgain) {
  write_campaign("c.toml", 40);
  EXPECT_TRUE(test::has_verdict(run("run c.toml --db f.db --keep failing")));
  const auto replayed = run("replay f.db " + folded_run("f.db"));
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_THAT(replayed.out, HasSubstr("nothing went wrong in it, and it is folded"));
  const auto verified = run("verify f.db --sample 100%");
  EXPECT_EQ(verified.exit_code, 0) << verified.out;
  EXPECT_THAT(verified.out, HasSubstr("160 simulated again: 160 agree, 0 differ"));
  // What came out otherwise is noticed by the bits that were kept.
  const auto other = other_program("replay f.db " + folded_run("f.db"));
  EXPECT_EQ(other.exit_code, 0) << "another program, the same run: " << other.out;
}

TEST_F(KeepFailing, AFinishedCampaignIsLeftAsItIs) {
  write_campaign("c.toml", 40);
  const int code = run("run c.toml --db f.db --keep failing").exit_code;
  const std::string before = read(path("f.db"));
  std::filesystem::remove(path("f.sessions.jsonl"));
  EXPECT_EQ(run("run c.toml --db f.db --keep failing").exit_code, code);
  EXPECT_TRUE(read(path("f.db")) == before);
  EXPECT_THAT(read(path("f.sessions.jsonl")), StartsWith("{\"started_utc\""));
  const std::string page = run("report f.db").out;
  EXPECT_THAT(page, Not(HasSubstr("cannot be read"))) << read(path("attempts.jsonl"));
  const auto more = run("run c.toml --db f.db --replicates 41");
  EXPECT_EQ(more.exit_code, 2);
  EXPECT_THAT(more.err, HasSubstr("folded (keep = \"failing\"), so this campaign cannot go on"));
  EXPECT_TRUE(read(path("f.db")) == before);
  const auto wrong = run("run c.toml --db g.db --keep some");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--keep: \"some\""));
}

// Stopped before its end, it keeps all rows, goes on, and is folded in the end.
TEST_F(KeepFailing, AStoppedCampaignGoesOn) {
  write_campaign("c.toml", 40);
  run("run c.toml --db one.db --keep failing");
  const auto stopped = run("run c.toml --db f.db --keep failing --fail-fast 3");
  ASSERT_TRUE(test::has_verdict(stopped));
  ASSERT_FALSE(ArchiveReader(path("f.db")).is_folded());
  run("run c.toml --db f.db --keep failing");
  EXPECT_TRUE(read(path("f.db")) == read(path("one.db")));
}

TEST_F(KeepFailing, ShardsGiveTheFileOfOneMachine) {
  write_campaign("c.toml", 60, "\"hull-lock\", \"reckless\"", "keep = \"failing\"\n");
  const std::string single = single_file();
  for (const char* shard : {"2/2", "1/2"}) EXPECT_EQ(run_shard("out", shard).exit_code, 0);
  EXPECT_EQ(merge("out", "m.db"), single_code_);
  EXPECT_TRUE(read(path("m.db")) == single);
  EXPECT_EQ(merge("out", "all.db", "--keep all"), single_code_);
  EXPECT_FALSE(ArchiveReader(path("all.db")).is_folded());
}

}  // namespace
}  // namespace fleetproof::keep_failing_test
