#include "campaign/shards/canary.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>

#include "core/base/error.hpp"
#include "tests/storage/refusal.hpp"
#include "tests/storage/sample_records.hpp"
#include "tests/support/own_process.hpp"

namespace fleetproof::canary_test {
namespace {

using testing::HasSubstr;

// As on a full disk: an empty canary would refuse every other shard of the folder.
TEST(Canary, IsPublishedWholeOrNotAtAll) {
  const samples::TemporaryFolder place;
  const ShardFolder folder(place / "out");
  folder.make();
  const int refused = test::in_own_process([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_FSIZE, &none);
    return test::sentence_of<MachineError>([&] { check_canary(folder, "0123 hull-lock\n"); }).empty() ? 1 : 0;
  });
  EXPECT_EQ(refused, 0);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
    EXPECT_TRUE(entry.is_directory()) << entry.path();
  check_canary(folder, "0123 hull-lock\n");
  check_canary(folder, "0123 hull-lock\n");
  EXPECT_THAT(test::sentence_of<MachineError>([&] { check_canary(folder, "0124 hull-lock\n"); }),
              HasSubstr("computes differently"));
}

}  // namespace
}  // namespace fleetproof::canary_test
