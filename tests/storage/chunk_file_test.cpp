#include "storage/chunk_file.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "core/base/error.hpp"
#include "storage/run_bytes.hpp"
#include "tests/storage/refusal.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::chunk_file_test {
namespace {

using testing::HasSubstr;

class ChunkFiles : public testing::Test {
 protected:
  void SetUp() override {
    runs_[2].recording = std::string("calls\0of agents", 15);
    write(path_);
  }
  void write(const std::string& path) const {
    ChunkContent content;
    for (const RunRecord& run : runs_) content.run_bytes += encode(run).size();
    content.encoded = [&](std::uint64_t place) { return encode(runs_[place]); };
    content.audits = {audits_[1], audits_[0]};
    write_chunk_file(path, label_, content);
  }
  // Everything that a merge reads of a chunk.
  static void read_all(const std::string& path) {
    ChunkFile file(path);
    file.require_intact();
    file.for_each_run([](const RunRecord&) {});
    file.audits();
  }

  const samples::TemporaryFolder folder_;
  const std::string path_ = folder_ / "a.chunk";
  std::vector<RunRecord> runs_ = samples::runs(3);
  const std::vector<AuditRecord> audits_{{0, 0xffffffffffffffffULL, audited_outcome(runs_[0])},
                                         {2, 77, audited_outcome(runs_[1])}};
  const ChunkLabel label_{0xfedcba9876543210ULL, "nightly", "fleetproof 0.1.0 sha256 ab12", 0, 0, 3};
};

TEST_F(ChunkFiles, GiveBackWhatWasWritten) {
  ChunkFile file(path_);
  EXPECT_EQ(file.label(), label_);
  file.require_intact();
  std::uint64_t next = 0;
  file.for_each_run([&](const RunRecord& run) {
    const RunRecord& expected = runs_.at(next++);
    EXPECT_TRUE(run.outcome == expected.outcome);
    EXPECT_EQ(run.run_index, expected.run_index);
    EXPECT_EQ(run.cell, expected.cell);
    EXPECT_EQ(run.replicate, expected.replicate);
    EXPECT_EQ(run.scenario_digest, expected.scenario_digest);
    EXPECT_EQ(run.factors, expected.factors);
    EXPECT_EQ(run.recording, expected.recording);
  });
  EXPECT_EQ(next, 3U);
  EXPECT_EQ(file.audits(), audits_);
  write(folder_ / "again.chunk");
  EXPECT_EQ(samples::bytes_of(folder_ / "again.chunk"), samples::bytes_of(path_));
}

TEST_F(ChunkFiles, EveryFlippedByteIsNoticed) {
  const std::string bytes = samples::bytes_of(path_);
  for (std::size_t at = 0; at < bytes.size(); at += at < 300 || at + 60 > bytes.size() ? 1 : 11) {
    std::string flipped = bytes;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x10);
    samples::write_bytes(path_, flipped);
    EXPECT_ANY_THROW(read_all(path_)) << at;
  }
}

TEST_F(ChunkFiles, EveryTruncationIsIncomplete) {
  const std::string bytes = samples::bytes_of(path_);
  for (std::size_t length = 0; length < bytes.size(); length += length < 300 || length + 60 > bytes.size() ? 1 : 11) {
    samples::write_bytes(path_, bytes.substr(0, length));
    EXPECT_THAT(test::sentence_of<EngineError>([&] { read_all(path_); }), HasSubstr("this chunk is incomplete"));
  }
  samples::write_bytes(path_, bytes + "x");
  EXPECT_THAT(test::sentence_of<EngineError>([&] { read_all(path_); }), HasSubstr("1 bytes follow its end"));
}

TEST_F(ChunkFiles, OtherFilesAreRefused) {
  samples::write_bytes(path_, "SQLite format 3 and much more than the head of a chunk");
  EXPECT_THAT(test::sentence_of<InputError>([&] { ChunkFile{path_}; }), HasSubstr("this is no chunk"));
  EXPECT_THAT(test::sentence_of<InputError>([&] { ChunkFile{folder_ / "none.chunk"}; }), HasSubstr("no such file"));
  ASSERT_EQ(::mkfifo((folder_ / "pipe.chunk").c_str(), 0644), 0);
  EXPECT_THAT(test::sentence_of<InputError>([&] { ChunkFile{folder_ / "pipe.chunk"}; }), HasSubstr("no regular file"));
  EXPECT_TRUE(is_chunk_there(path_));
  EXPECT_FALSE(is_chunk_there(folder_ / "none.chunk"));
  EXPECT_THROW(is_chunk_there(folder_ / "pipe.chunk"), InputError);
}

}  // namespace
}  // namespace fleetproof::chunk_file_test
