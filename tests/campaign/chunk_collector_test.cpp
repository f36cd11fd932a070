#include "campaign/shards/chunk_collector.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "core/base/error.hpp"
#include "tests/storage/refusal.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::chunk_collector_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class ChunkCollectors : public testing::Test {
 protected:
  ChunkCollector collector() const { return {folder_, grid_, label_}; }
  std::vector<bool> published() const {
    std::vector<bool> all;
    for (std::uint64_t chunk = 0; chunk < grid_.count(); ++chunk) all.push_back(fs::exists(folder_.chunk_file(chunk)));
    return all;
  }

  const samples::TemporaryFolder place_;
  const ShardFolder folder_{place_ / "out"};
  const ChunkGrid grid_{40};  // chunks of 16, 16 and 8 runs
  const ChunkLabel label_{7, "nightly", "ab12", 0, 0, 0};
  std::vector<RunRecord> runs_ = samples::runs(40);
};

TEST_F(ChunkCollectors, PublishAChunkWhenItsLastRunIsThere) {
  ChunkCollector collector = this->collector();
  for (std::size_t i = runs_.size(); i-- > 16;) collector.add(runs_[i], false);
  for (std::size_t i = 1; i < 16; ++i) collector.add(runs_[i], false);
  collector.publish();
  EXPECT_EQ(published(), (std::vector<bool>{false, true, true}));
  EXPECT_EQ(collector.open_runs(), 15U);
  collector.add(runs_[0], false);
  collector.publish();
  EXPECT_EQ(published(), (std::vector<bool>{true, true, true}));
  EXPECT_EQ(collector.published(), 3U);
  ChunkFile last(folder_.chunk_file(2));
  last.require_intact();
  std::uint64_t next = 32;
  last.for_each_run([&](const RunRecord& run) { EXPECT_TRUE(run.outcome == runs_.at(next++).outcome); });
  EXPECT_EQ(next, 40U);
}

TEST_F(ChunkCollectors, WaitForAudits) {
  ChunkCollector collector = this->collector();
  for (const RunRecord& run : runs_)
    collector.add(run, run.run_index == 3 || run.run_index == 9 || run.run_index == 20);
  collector.publish();
  EXPECT_EQ(published(), (std::vector<bool>{false, false, true}));
  EXPECT_TRUE(collector.waits_for_audits());
  collector.add(AuditRecord{9, 99, audited_outcome(runs_[9])});
  collector.publish();
  EXPECT_FALSE(published()[0]);
  collector.add(AuditRecord{3, 33, audited_outcome(runs_[3])});
  collector.publish();
  EXPECT_TRUE(published()[0]);
  ChunkFile first(folder_.chunk_file(0));
  first.for_each_run([](const RunRecord&) {});
  EXPECT_EQ(first.audits(),
            (std::vector<AuditRecord>{{3, 33, audited_outcome(runs_[3])}, {9, 99, audited_outcome(runs_[9])}}));
  collector.audits_end();
  collector.add(AuditRecord{20, 1, audited_outcome(runs_[20])});
  collector.publish();
  EXPECT_FALSE(collector.waits_for_audits());
  EXPECT_EQ(published(), (std::vector<bool>{true, true, true}));
}

TEST_F(ChunkCollectors, OtherResultsForAPublishedChunkAreTheAlarm) {
  ChunkCollector first = collector(), again = collector(), other = collector();
  for (const RunRecord& run : runs_) {
    first.add(run, false);
    again.add(run, false);
    RunRecord changed = run;
    changed.outcome.digest += run.run_index == 18 ? 1 : 0;
    other.add(changed, false);
  }
  first.publish();
  const std::string before = samples::bytes_of(folder_.chunk_file(1));
  EXPECT_NO_THROW(again.publish());
  const std::string alarm = test::sentence_of<EngineError>([&] { other.publish(); });
  EXPECT_THAT(alarm, HasSubstr("000001.chunk: the same runs ended in two ways"));
  EXPECT_THAT(alarm, HasSubstr("run 18 is the first that differs"));
  EXPECT_EQ(samples::bytes_of(folder_.chunk_file(1)), before) << "the first stays";
  ASSERT_EQ(folder_.differing_files().size(), 1U);
  EXPECT_EQ(folder_.chunk_files().size(), 3U);
}

}  // namespace
}  // namespace fleetproof::chunk_collector_test
