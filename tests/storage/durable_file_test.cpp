#include "storage/durable_file.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <map>

#include "core/base/error.hpp"
#include "tests/storage/sample_records.hpp"

namespace fleetproof::durable_file_test {
namespace {

TEST(PublishOnce, AFileAppearsOnceAndIsNeverReplaced) {
  const samples::TemporaryFolder folder;
  const std::string target = folder / "a.chunk", from = folder / ".tmp";
  samples::write_bytes(from, "one");
  EXPECT_EQ(publish_once(from, target), Publication::First);
  EXPECT_FALSE(std::filesystem::exists(from));
  samples::write_bytes(from, "one");
  EXPECT_EQ(publish_once(from, target), Publication::Again);
  EXPECT_FALSE(std::filesystem::exists(from));
  for (const char* other : {"two", "on", "one ", ""}) {
    samples::write_bytes(from, other);
    EXPECT_EQ(publish_once(from, target), Publication::Differs) << other;
    EXPECT_EQ(samples::bytes_of(from), other) << "it stays";
    EXPECT_EQ(samples::bytes_of(target), "one");
  }
  EXPECT_THROW(publish_once(from, folder / "none/a.chunk"), MachineError);
  EXPECT_THROW(publish_once(folder / "none", target), MachineError);
}

// Eight processes at once, many times: exactly one is the first, and no other file ever stands there.
TEST(PublishOnce, OneOfManyIsTheFirst) {
  const samples::TemporaryFolder folder;
  const std::string large(100'000, 'x');
  for (int round = 0; round < 40; ++round) {
    const bool alike = round % 2 == 0;
    const std::string target = folder / std::to_string(round);
    std::array<int, 2> gate{};
    ASSERT_EQ(::pipe(gate.data()), 0);
    std::array<pid_t, 8> children{};
    for (std::size_t number = 0; number < children.size(); ++number) {
      children[number] = ::fork();
      if (children[number] != 0) continue;
      const std::string from = folder / (".tmp-" + std::to_string(number));
      samples::write_bytes(from, large + (alike ? "" : std::to_string(number)));
      ::close(gate[1]);
      char wait = 0;
      (void)!::read(gate[0], &wait, 1);  // until all of them are there
      ::_exit(static_cast<int>(publish_once(from, target)));
    }
    ::close(gate[0]);
    ::close(gate[1]);
    std::map<int, int> count;
    for (const pid_t child : children) {
      int status = 0;
      ::waitpid(child, &status, 0);
      ASSERT_TRUE(WIFEXITED(status));
      ++count[WEXITSTATUS(status)];
    }
    EXPECT_EQ(count[static_cast<int>(Publication::First)], 1);
    EXPECT_EQ(count[static_cast<int>(alike ? Publication::Again : Publication::Differs)], 7);
    EXPECT_EQ(samples::bytes_of(target).substr(0, large.size()), large);
  }
}

}  // namespace
}  // namespace fleetproof::durable_file_test
