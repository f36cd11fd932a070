#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <set>
#include <thread>

#include "core/base/error.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::archive_test {
namespace {

using samples::TemporaryFolder;

void write_archive(const std::string& path, const std::vector<RunRecord>& runs, std::uint64_t stop_index,
                   std::size_t commit_every = 0) {
  ArchiveWriter writer(path, samples::plan());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    writer.add(runs[i]);
    if (commit_every != 0 && i % commit_every == 0) writer.commit();
  }
  writer.publish(stop_index);
}

void expect_equal(const RunRecord& read, const RunRecord& written) {
  EXPECT_EQ(read.run_index, written.run_index);
  EXPECT_EQ(read.cell, written.cell);
  EXPECT_EQ(read.replicate, written.replicate);
  EXPECT_EQ(read.scenario_digest, written.scenario_digest);
  EXPECT_EQ(read.outcome, written.outcome);
}

TEST(Archive, comes_back_as_it_went) {
  const TemporaryFolder folder;
  const auto runs = samples::runs(60);
  write_archive(folder / "a.fp", runs, 60);
  const ArchiveReader reader(folder / "a.fp");
  EXPECT_EQ(reader.campaign(), samples::campaign());
  EXPECT_EQ(reader.cells(), samples::cells());
  EXPECT_EQ(reader.gates(), samples::gates());
  EXPECT_EQ(reader.run_count(), 60u);
  std::size_t next = 0;
  reader.for_each_run([&](const RunRecord& run) { expect_equal(run, runs.at(next++)); });
  EXPECT_EQ(next, 60u);
  expect_equal(reader.run(37).value(), runs[37]);
  EXPECT_FALSE(reader.run(60).has_value());
}

TEST(Archive, a_single_run_can_be_read_while_all_are_visited) {
  const TemporaryFolder folder;
  write_archive(folder / "a.fp", samples::runs(12), 12);
  const ArchiveReader reader(folder / "a.fp");
  int same = 0;
  reader.for_each_run([&](const RunRecord& run) { same += reader.run(run.run_index)->outcome == run.outcome; });
  EXPECT_EQ(same, 12);
}

TEST(Archive, the_bytes_do_not_depend_on_the_order_or_the_commits) {
  const TemporaryFolder folder;
  auto runs = samples::runs(1500);  // more than one automatic commit
  write_archive(folder / "ordered.fp", runs, 1400);
  const auto bytes = samples::bytes_of(folder / "ordered.fp");
  ASSERT_GT(bytes.size(), 100'000u);
  std::mt19937_64 random(11);
  for (const std::size_t commit_every : {0u, 13u, 400u}) {
    std::ranges::shuffle(runs, random);
    const auto name = folder / ("shuffled" + std::to_string(commit_every) + ".fp");
    write_archive(name, runs, 1400, commit_every);
    EXPECT_TRUE(samples::bytes_of(name) == bytes) << "commit every " << commit_every;
  }
}

TEST(Archive, rows_beyond_the_stop_index_leave_no_trace) {
  const TemporaryFolder folder;
  const auto runs = samples::runs(90);
  write_archive(folder / "more.fp", runs, 60);
  write_archive(folder / "exact.fp", {runs.begin(), runs.begin() + 60}, ~std::uint64_t{0});
  EXPECT_TRUE(samples::bytes_of(folder / "more.fp") == samples::bytes_of(folder / "exact.fp"));
  EXPECT_EQ(ArchiveReader(folder / "more.fp").run_count(), 60u);
}

TEST(Archive, one_changed_value_changes_bytes_and_content_digest) {
  const TemporaryFolder folder;
  auto runs = samples::runs(30);
  write_archive(folder / "a.fp", runs, 30);
  write_archive(folder / "same.fp", runs, 30);
  runs[17].outcome.counters.turns ^= 1;
  write_archive(folder / "b.fp", runs, 30);
  EXPECT_FALSE(samples::bytes_of(folder / "a.fp") == samples::bytes_of(folder / "b.fp"));
  const auto digest = [&](const char* name) { return ArchiveReader(folder / name).content_digest(); };
  EXPECT_EQ(digest("a.fp"), digest("same.fp"));
  EXPECT_NE(digest("a.fp"), digest("b.fp"));
}

TEST(Archive, the_content_digest_is_that_of_the_live_file_and_covers_the_plan) {
  const TemporaryFolder folder;
  const auto digest_with = [&](const std::string& name, const CampaignRecord& campaign) {
    ArchiveWriter writer(folder / name, {campaign, samples::cells(), samples::gates()});
    for (const auto& run : samples::runs(12)) writer.add(run);
    writer.commit();
    const auto live = ArchiveReader(folder / (name + ".partial")).content_digest();
    writer.publish(12);
    EXPECT_EQ(ArchiveReader(folder / name).content_digest(), live);
    return live;
  };
  auto other = samples::campaign();
  other.seed ^= 1;
  EXPECT_NE(digest_with("a.fp", samples::campaign()), digest_with("b.fp", other));
}

TEST(Archive, the_digest_of_results_leaves_out_the_engine_and_nothing_else) {
  const TemporaryFolder folder;
  auto runs = samples::runs(12);
  const auto digests = [&](const std::string& name, const CampaignRecord& campaign) {
    ArchiveWriter writer(folder / name, {campaign, samples::cells(), samples::gates()});
    for (const auto& run : runs) writer.add(run);
    writer.publish(12);
    const ArchiveReader archive(folder / name);
    return std::pair{archive.results_digest(), archive.content_digest()};
  };
  const auto [results, content] = digests("a.fp", samples::campaign());
  auto clang = samples::campaign();
  clang.engine = {"0.2.0", "cd34", "Clang 14", "-O0", "SQLite 3.41.0"};
  EXPECT_EQ(digests("clang.fp", clang).first, results);
  EXPECT_NE(digests("clang2.fp", clang).second, content);
  auto other_plan = samples::campaign();
  other_plan.plan_json += " ";
  EXPECT_NE(digests("plan.fp", other_plan).first, results);
  runs[7].outcome.digest ^= 1;
  EXPECT_NE(digests("row.fp", samples::campaign()).first, results);
}

TEST(Archive, only_the_campaign_file_is_left_in_the_folder) {
  const TemporaryFolder folder;
  write_archive(folder / "a.fp", samples::runs(6), 6);
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "."))
    names.insert(entry.path().filename().string());
  EXPECT_THAT(names, testing::ElementsAre("a.fp"));
}

TEST(Archive, without_publishing_the_rows_stay_in_the_live_file) {
  const TemporaryFolder folder;
  {
    ArchiveWriter writer(folder / "a.fp", samples::plan());
    for (const auto& run : samples::runs(5)) writer.add(run);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.fp"));
  EXPECT_EQ(ArchiveReader(folder / "a.fp.partial").run_count(), 5u);
}

TEST(Archive, a_killed_writer_loses_nothing_that_was_committed) {
  const TemporaryFolder folder;
  const auto runs = samples::runs(20);
  const auto child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ArchiveWriter writer(folder / "a.fp", samples::plan());
    for (std::size_t i = 0; i < 12; ++i) writer.add(runs[i]);
    writer.commit();
    for (std::size_t i = 12; i < 20; ++i) writer.add(runs[i]);
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const ArchiveReader reader(folder / "a.fp.partial");
  std::size_t next = 0;
  reader.for_each_run([&](const RunRecord& run) { expect_equal(run, runs.at(next++)); });
  EXPECT_EQ(next, 12u);
}

// What a kill loses at most: the caller commits nothing here.
TEST(Archive, what_was_added_two_seconds_ago_is_committed) {
  const TemporaryFolder folder;
  const auto runs = samples::runs(4);
  ArchiveWriter writer(folder / "a.fp", samples::plan());
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < 3; ++i) writer.add(runs[i]);
  const std::uint64_t at_once = ArchiveReader(folder / "a.fp.partial").run_count();
  if (std::chrono::steady_clock::now() - begin < std::chrono::seconds(2)) {
    EXPECT_EQ(at_once, 0U) << "a commit for each run would be slow";
  }
  std::this_thread::sleep_until(begin + std::chrono::milliseconds(2100));
  writer.add(runs[3]);
  EXPECT_EQ(ArchiveReader(folder / "a.fp.partial").run_count(), 4U);
}

TEST(Archive, the_same_run_twice_is_stored_once_but_never_with_two_outcomes) {
  const TemporaryFolder folder;
  ArchiveWriter writer(folder / "a.fp", samples::plan());
  auto runs = samples::runs(3);
  for (const auto& run : runs) writer.add(run);
  EXPECT_NO_THROW(writer.add(runs[1]));
  runs[1].outcome.digest ^= 1;
  EXPECT_THROW(writer.add(runs[1]), EngineError);
  writer.publish(3);
  EXPECT_EQ(ArchiveReader(folder / "a.fp").run(1)->outcome, samples::runs(3)[1].outcome);
}

TEST(Archive, a_run_index_that_does_not_belong_to_cell_and_replicate_is_our_bug) {
  const TemporaryFolder folder;
  ArchiveWriter writer(folder / "a.fp", samples::plan());
  auto run = samples::runs(1)[0];
  run.run_index = 5;
  EXPECT_THROW(writer.add(run), InvariantViolation);
}

}  // namespace
}  // namespace fleetproof::archive_test
