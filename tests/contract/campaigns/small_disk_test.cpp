// A campaign on a disk that really is full: a small file system in memory, in a name space of its own.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof::small_disk_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class SmallDisk : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    if (run_in_name_space("true").exit_code != 0) GTEST_SKIP() << "no file system can be mounted here";
    write("c.toml",
          "name = \"c\"\nkind = \"search\"\nseed = 5\nreplicates = 300\nhorizon_s = 60\n[factors]\n"
          "agents = [\"hull-lock\", \"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [3]\n");
    shell("\"$FLEETPROOF\" run c.toml --db whole.db");
    ASSERT_GT(read(path("whole.db")).size(), 200'000U);
  }
  // The folder `small` is a disk of this size at first, and has room later.
  test::Finished campaign_on(const std::string& size) {
    return run_in_name_space("mount -o remount,size=" + size +
                             " small\n\"$FLEETPROOF\" run c.toml --db small/c.db >/dev/null 2>first.txt\n"
                             "echo first $?\nls small | sed 's/^/left /'\nmount -o remount,size=8m small\n"
                             "\"$FLEETPROOF\" run c.toml --db small/c.db >/dev/null 2>second.txt\necho second $?\n"
                             "cmp small/c.db whole.db && echo same\n");
  }
  test::Finished run_in_name_space(const std::string& lines) {
    write("lines.sh", "set -u\nmkdir -p small\nmount -t tmpfs -o size=1m tmpfs small || exit 77\n" + lines);
    return shell("unshare --user --map-root-user --mount bash lines.sh");
  }
};

TEST_F(SmallDisk, KeepsWhatWasCommittedAndTheNextRunGoesOn) {
  const auto seen = campaign_on("200k");
  EXPECT_THAT(seen.out, HasSubstr("first 3\n"));
  const std::string talk = read(path("first.txt"));
  EXPECT_THAT(talk, HasSubstr("error: "));
  EXPECT_THAT(talk, HasSubstr("the disk is full; free some space, then the same command goes on"));
  EXPECT_THAT(talk, Not(HasSubstr("engine fault")));
  EXPECT_THAT(seen.out, Not(HasSubstr("left c.db\n")));
  EXPECT_THAT(seen.out, HasSubstr("second 4\n"));
  EXPECT_THAT(seen.out, HasSubstr("same\n"));
}

// All runs are stored, but there is no room for the published file beside the live one.
TEST_F(SmallDisk, AFinishedCampaignIsPublishedLaterAndNotSimulatedAgain) {
  // The size of the live file depends on the number of its commits, so the fitting disk is looked for: on a smaller one
  // runs have no room, and a larger one has room for both files.
  test::Finished seen;
  std::string talk;
  for (int least_k = 200, most_k = 900; most_k - least_k > 5;) {
    const int size_k = (least_k + most_k) / 2;
    seen = campaign_on(std::to_string(size_k) + "k");
    talk = read(path("first.txt"));
    if (talk.find("c.db.unfinished: the disk is full") != std::string::npos) break;
    (seen.out.find("first 3\n") != std::string::npos ? least_k : most_k) = size_k;
  }
  ASSERT_THAT(talk, HasSubstr("c.db.unfinished: the disk is full; free some space"));
  EXPECT_THAT(seen.out, HasSubstr("first 3\n"));
  EXPECT_THAT(seen.out, HasSubstr("left c.db.partial\n"));
  EXPECT_THAT(seen.out, Not(HasSubstr("left c.db.unfinished\n")));
  EXPECT_THAT(read(path("second.txt")), HasSubstr("(0 runs/s)")) << "nothing was simulated";
  EXPECT_THAT(seen.out, HasSubstr("same\n"));
}

}  // namespace
}  // namespace fleetproof::small_disk_test
