#include "storage/line_log.hpp"

#include <gmock/gmock.h>

#include "core/base/error.hpp"
#include "core/base/machine_error.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof {
namespace {

using samples::TemporaryFolder;

// Whether a file with these bytes may be appended to as a log that begins with {"begun":
bool is_accepted(const std::string& bytes) {
  const TemporaryFolder folder;
  const std::string path = folder / "log.jsonl";
  samples::write_bytes(path, bytes);
  try {
    require_log(path, "{\"begun\":", "this is no log");
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
  EXPECT_NO_THROW(require_log(folder / "log.jsonl", "{", "this is no log"));
  append_lines(folder / "log.jsonl", "{}\n");
  append_lines(folder / "log.jsonl", "{\"a\":1}\n{}\n");
  EXPECT_EQ(samples::bytes_of(folder / "log.jsonl"), "{}\n{\"a\":1}\n{}\n");
}

TEST(LineLog, AFolderIsNeverWrittenTo) {
  const TemporaryFolder folder;
  EXPECT_THROW(append_lines(folder / ".", "{}\n"), MachineError);
}

TEST(LineLog, TheSessionLogStandsBesideTheArchive) {
  EXPECT_EQ(session_log_path("there/night.db"), "there/night.sessions.jsonl");
}

}  // namespace
}  // namespace fleetproof
