// A disk that is full, or fails, while a campaign is stored.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "tests/storage/refusal.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::full_disk_test {
namespace {

using samples::TemporaryFolder;
using test::sentence_of;
using test::tamper;
using testing::HasSubstr;

// While it lives, no file of this process grows beyond `bytes`.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : former_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &former_);
    const rlimit low{bytes, former_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &low);
  }
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, former_handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  void (*former_handler_)(int);
  rlimit former_{};
};

TEST(ArchiveWriter, a_disk_that_fills_up_is_an_engine_error_and_keeps_what_was_committed) {
  const TemporaryFolder folder;
  const auto runs = samples::runs(3000);
  std::string sentence;
  {
    ArchiveWriter writer(folder / "a.fp", samples::plan());
    for (std::size_t i = 0; i < 100; ++i) writer.add(runs[i]);
    writer.commit();
    const SmallDisk disk(400'000);
    sentence = sentence_of<EngineError>([&] {
      for (std::size_t i = 100; i < runs.size(); ++i) writer.add(runs[i]);
      writer.commit();
    });
  }
  EXPECT_THAT(sentence, HasSubstr("disk"));
  EXPECT_THAT(sentence, HasSubstr("a.fp.partial"));
  const ArchiveReader reader(folder / "a.fp.partial");
  EXPECT_GE(reader.run_count(), 100u);
  EXPECT_EQ(reader.run(99)->outcome, runs[99].outcome);
}

TEST(ArchiveWriter, after_an_error_half_a_run_is_never_committed) {
  const TemporaryFolder folder;
  const auto path = folder / "a.fp";
  auto runs = samples::runs(3);
  runs[2].outcome.probes = {{ProbeSource::World, "crossing", 1}};
  {
    ArchiveWriter writer(path, samples::plan());
    writer.add(runs[0]);
    writer.commit();
    tamper(path + ".partial", "CREATE TRIGGER t BEFORE INSERT ON probes BEGIN SELECT RAISE(ABORT, 'no'); END");
    EXPECT_THROW(writer.add(runs[2]), EngineError);  // its row is in, its probe is not
    EXPECT_THROW(writer.add(runs[1]), InvariantViolation);
  }
  tamper(path + ".partial", "DROP TRIGGER t");  // a reader refuses a file with one
  EXPECT_EQ(ArchiveReader(path + ".partial").run_count(), 1u);
}

// The copy finds no room; later there is room, and every run is there.
TEST(ArchiveWriter, a_disk_too_small_for_a_second_copy_costs_no_run) {
  const TemporaryFolder folder;
  const auto path = folder / "a.fp";
  const auto runs = samples::runs(600);
  {
    ArchiveWriter writer(folder / "whole.fp", samples::plan());
    for (const auto& run : runs) writer.add(run);
    writer.publish(600);
  }
  std::string sentence;
  {
    ArchiveWriter writer(path, samples::plan());
    for (const auto& run : runs) writer.add(run);
    writer.commit();
    const SmallDisk disk(100'000);
    sentence = sentence_of<EngineError>([&] { writer.publish(600); });
  }
  EXPECT_THAT(sentence, HasSubstr("disk"));
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".unfinished"));
  std::size_t stored = 0;
  Resumption resumption;
  resumption.visit = [&](const RunRecord&) { ++stored; };
  ArchiveWriter(path, samples::plan(), Existing::Resume, resumption).publish(600);
  EXPECT_EQ(stored, 600u);
  EXPECT_TRUE(samples::bytes_of(path) == samples::bytes_of(folder / "whole.fp"));
}

}  // namespace
}  // namespace fleetproof::full_disk_test
