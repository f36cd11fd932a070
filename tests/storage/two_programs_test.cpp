// Two programs at one results file: two writers, or a writer and its readers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "core/base/error.hpp"
#include "storage/archive_reader.hpp"
#include "storage/archive_writer.hpp"
#include "storage/write_lock.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::two_programs_test {
namespace {

using samples::TemporaryFolder;

constexpr int kWon = 0, kRefused = 1, kSlow = 2, kOtherError = 3;

// The soak asks for more by these variables of the environment.
int number_of(const char* variable, int quick) {
  const char* wanted = std::getenv(variable);
  return wanted != nullptr ? std::atoi(wanted) : quick;
}

// The lock file of a campaign belongs to the user who began it; others can read it, and that is enough to ask for it.
TEST(TwoUsers, LearnThatTheOtherIsWriting) {
  const TemporaryFolder folder;
  const std::string path = folder / "night.db";
  ASSERT_EQ(::chmod((folder / ".").c_str(), 0755), 0);
  const WriteLock held(path);
  ASSERT_EQ(::chmod((path + ".lock").c_str(), 0444), 0);
  const auto ask = [&](const std::string& name) {
    if (::geteuid() == 0 && ::setuid(65534) != 0) ::_exit(2);
    try {
      const WriteLock other(name);
      std::fputs("locked", stderr);
    } catch (const InputError& refused) {
      std::fputs(refused.what(), stderr);
    }
    ::_exit(0);
  };
  EXPECT_EXIT(ask(path), testing::ExitedWithCode(0), "another fleetproof run is writing this file");
  ASSERT_EQ(::chmod((folder / ".").c_str(), 0555), 0);
  EXPECT_EXIT(ask(folder / "mine.db"), testing::ExitedWithCode(0), "mine.db.lock.*may not be made here");
  ASSERT_EQ(::chmod((folder / ".").c_str(), 0755), 0);
}

// Both ends in this process; the children inherit them.
struct Pipe {
  Pipe() { EXPECT_EQ(::pipe(ends), 0); }
  ~Pipe() {
    for (const int end : ends) ::close(end);
  }
  void send() const { EXPECT_EQ(::write(ends[1], "x", 1), 1); }
  void wait() const {
    char byte = 0;
    EXPECT_EQ(::read(ends[0], &byte, 1), 1);
  }
  int ends[2]{};
};

// Waits for the shot, then writes the file. A winner publishes when it is told to.
int race(const std::string& path, const Pipe& start, const Pipe& opened, const Pipe& finish) {
  start.wait();
  const auto begin = std::chrono::steady_clock::now();
  try {
    ArchiveWriter writer(path, samples::plan(), Existing::Resume);
    opened.send();
    finish.wait();
    for (const auto& run : samples::runs(6)) writer.add(run);
    writer.publish(6);
    return kWon;
  } catch (const InputError& e) {
    opened.send();
    if (std::chrono::steady_clock::now() - begin > std::chrono::seconds(1)) return kSlow;
    return std::string(e.what()).find("another fleetproof run is writing this file") != std::string::npos ? kRefused
                                                                                                          : kOtherError;
  } catch (...) {
    opened.send();
    return kOtherError;
  }
}

int exit_code_of(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(TwoPrograms, OfTwoWritersOneWinsAndTheOtherIsRefusedAtOnce) {
  const TemporaryFolder folder;
  const int races = number_of("FLEETPROOF_RACES", 30);
  for (int round = 0; round < races && !testing::Test::HasFailure(); ++round) {
    const std::string path = folder / ("r" + std::to_string(round) + ".fp");
    const Pipe start, opened, finish;
    std::array<pid_t, 2> children{};
    for (pid_t& child : children) {
      child = ::fork();
      if (child == 0) ::_exit(race(path, start, opened, finish));
    }
    for (int i = 0; i < 2; ++i) start.send();
    for (int i = 0; i < 2; ++i) opened.wait();
    for (int i = 0; i < 2; ++i) finish.send();
    std::vector<int> codes;
    for (const pid_t child : children) codes.push_back(exit_code_of(child));
    EXPECT_THAT(codes, testing::UnorderedElementsAre(kWon, kRefused)) << round;
    EXPECT_EQ(ArchiveReader(path).run_count(), 6U);
    EXPECT_FALSE(std::filesystem::exists(path + ".lock"));
    EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
  }
}

// The writer may write seven rows for each read that begins. So it is at work during all of them, and the file does not
// grow beyond what a read of all rows can take.
TEST(TwoPrograms, ReadersOfAWriterAtWorkSeeAWholeStateAndNoError) {
  const int reads = number_of("FLEETPROOF_READS", 1000);
  const TemporaryFolder folder;
  const std::string path = folder / "a.fp";
  const Pipe opened, read_begins;
  const auto runs = samples::runs(600);
  const pid_t writer = ::fork();
  if (writer == 0) {
    try {
      ArchiveWriter archive(path, samples::plan());
      opened.send();
      std::uint64_t index = 0;
      for (RunRecord run;; ++index) {
        run = runs[index % runs.size()];
        run.run_index = index;
        run.replicate = index / samples::cells().size();
        archive.add(run);
        if (index % 7 != 6) continue;
        archive.commit();
        read_begins.wait();
      }
    } catch (...) {
    }
    ::_exit(1);  // only a signal ends the writer
  }
  opened.wait();
  std::uint64_t seen = 0;
  for (int i = 0; i < reads && !testing::Test::HasFailure(); ++i) {
    try {
      read_begins.send();
      const ArchiveReader reader(path + ".partial");
      const std::uint64_t count = reader.run_count();
      EXPECT_GE(count, seen) << "rows never go away";
      seen = count;
      if (count > 0) {
        EXPECT_EQ(reader.run(count - 1)->outcome, runs[(count - 1) % runs.size()].outcome);
      }
      if (i % 100 == 0) {
        std::uint64_t next = 0;
        reader.for_each_run([&](const RunRecord& run) { EXPECT_EQ(run.run_index, next++); });
        EXPECT_GE(next, count);
      }
    } catch (const std::exception& e) {
      ADD_FAILURE() << "read " << i << ": " << e.what();
    }
  }
  EXPECT_GT(seen, 100U);
  ::kill(writer, SIGKILL);
  EXPECT_EQ(exit_code_of(writer), 128 + SIGKILL) << "the writer had no error either";
}

}  // namespace
}  // namespace fleetproof::two_programs_test
