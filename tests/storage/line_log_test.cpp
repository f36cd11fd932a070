#include "storage/line_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>

#include "core/base/error.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::line_log_test {
namespace {

using samples::TemporaryFolder;

// Whether a file with these bytes may be appended to as a log that begins with {"begun":
bool is_accepted(const std::string& bytes) {
  const TemporaryFolder folder;
  const std::string path = folder / "log.jsonl";
  samples::write_bytes(path, bytes);
  try {
    read_log(path, "{\"begun\":", "this is no log");
  } catch (const InputError& refused) {
    EXPECT_THAT(refused.what(), testing::AllOf(testing::HasSubstr("log.jsonl"), testing::HasSubstr("this is no log")));
    return false;
  }
  return true;
}

TEST(LineLog, OnlyAFileThatBeginsWithTheFirstWordsIsALog) {
  EXPECT_TRUE(is_accepted("{\"begun\":1}\n"));
  EXPECT_TRUE(is_accepted("{\"begun\":1}\nbroken\n"));
  EXPECT_TRUE(is_accepted("")) << "nothing is lost";
  EXPECT_FALSE(is_accepted("my notes\n"));
  EXPECT_FALSE(is_accepted("my notes\n{\"begun\":1}\n"));
  EXPECT_FALSE(is_accepted("see {\"begun\":1}\n"));
  EXPECT_FALSE(is_accepted("\n{\"begun\":1}\n"));
  EXPECT_FALSE(is_accepted("{\"begun\n"));
}

TEST(LineLog, AFileThatIsNotThereIsBegun) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(read_log(folder / "log.jsonl", "{", "this is no log"));
  append_lines(folder / "log.jsonl", "{}\n");
  append_lines(folder / "log.jsonl", "{\"a\":1}\n{}\n");
  EXPECT_EQ(samples::bytes_of(folder / "log.jsonl"), "{}\n{\"a\":1}\n{}\n");
}

TEST(LineLog, AFolderIsNeverWrittenTo) {
  const TemporaryFolder folder;
  EXPECT_THROW(append_lines(folder / ".", "{}\n"), MachineError);
}

// Neither written to nor read: a pipe has no reader, a device takes all, and a huge file takes all memory.
TEST(LineLog, OnlyARegularFileOfUsualSizeIsAppendedTo) {
  const TemporaryFolder folder;
  const auto refused = [](const std::string& path) {
    EXPECT_THROW(append_lines(path, "{}\n"), MachineError) << path;
    EXPECT_THROW(append_after(path, [](std::uint64_t) { return "{}"; }), MachineError) << path;
  };
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  refused(folder / "pipe");
  refused("/dev/null");
  samples::write_bytes(folder / "huge", "{}\n");
  ASSERT_EQ(::truncate((folder / "huge").c_str(), (off_t{64} << 20) + 1), 0);
  EXPECT_THROW(append_after(folder / "huge", [](std::uint64_t) { return "{}"; }), MachineError);
}

// Says what comes out for a user who may write neither the file nor its folder.
std::string said_to_another_user(const std::string& path) {
  try {
    require_appendable(path, "name another");
  } catch (const InputError& refused) {
    return refused.what();
  }
  return "appendable";
}

TEST(LineLogOfAnotherUser, IsRefusedBeforeTheWork) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(require_appendable(folder / "new.jsonl", "name another"));
  append_lines(folder / "log.jsonl", "{}\n");
  EXPECT_NO_THROW(require_appendable(folder / "log.jsonl", "name another"));
  EXPECT_EQ(samples::bytes_of(folder / "log.jsonl"), "{}\n");
  ASSERT_EQ(::chmod((folder / "log.jsonl").c_str(), 0444), 0);
  ASSERT_EQ(::chmod((folder / ".").c_str(), 0555), 0);
  const auto ask = [&](const std::string& path) {
    if (::geteuid() == 0 && ::setuid(65534) != 0) ::_exit(2);
    std::fputs(said_to_another_user(path).c_str(), stderr);
    ::_exit(0);
  };
  EXPECT_EXIT(ask(folder / "log.jsonl"), testing::ExitedWithCode(0), "log.jsonl.*may not write here.*name another");
  EXPECT_EXIT(ask(folder / "new.jsonl"), testing::ExitedWithCode(0), "new.jsonl.*may not write here.*name another");
  ASSERT_EQ(::chmod((folder / ".").c_str(), 0755), 0);
}

TEST(LineLog, TheSessionLogStandsBesideTheArchive) {
  EXPECT_EQ(session_log_path("there/night.db"), "there/night.sessions.jsonl");
  EXPECT_EQ(session_log_path("there/night.db.partial"), "there/night.sessions.jsonl") << "a look at what still grows";
}

TEST(LineLog, TwoArchivesHaveTwo) {
  EXPECT_EQ(session_log_path("plant-1.1"), "plant-1.1.sessions.jsonl");
  EXPECT_EQ(session_log_path("plant-1.2"), "plant-1.2.sessions.jsonl");
  EXPECT_EQ(session_log_path("a.fp.partial"), "a.fp.sessions.jsonl") << "a.db is another campaign";
  EXPECT_EQ(session_log_path("v1.2/night"), "v1.2/night.sessions.jsonl");
}

}  // namespace
}  // namespace fleetproof::line_log_test
