// Files and folders that the user may not read or write: one clear error, exit code 2, nothing written.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"
#include "tests/support/unprivileged.hpp"

namespace fleetproof::permissions_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Permissions : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.toml",
          "horizon_s = 1\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [2]\n");
    ASSERT_EQ(run("run a.toml --db a.db").exit_code, 4);
    ASSERT_EQ(run("generate fishbone -o layout.json").exit_code, 0);
    ASSERT_EQ(run("replay a.db 0 --scenario scenario.json").exit_code, 0);
    std::filesystem::create_directory(path("locked"));
    // The folder of the build may be closed to others.
    std::filesystem::copy_file(FLEETPROOF_PROGRAM, path("program"));
    test::give_away(folder_);
  }
  void TearDown() override {
    std::filesystem::permissions(path("locked"), std::filesystem::perms::owner_all);
    ProgramTest::TearDown();
  }

  test::Finished run_unprivileged(const std::string& words) const {
    const bool root = ::geteuid() == 0;
    return shell((root ? "setpriv --reuid=65534 --regid=65534 --clear-groups ./program " : "./program ") + words);
  }
  void expect_refused(const std::string& words, const std::string& file) const {
    const auto finished = run_unprivileged(words);
    EXPECT_EQ(finished.exit_code, 2) << words << "\n" << finished.err;
    EXPECT_THAT(finished.err, AllOf(HasSubstr(file), HasSubstr("Permission denied"))) << words;
    EXPECT_EQ(std::ranges::count(finished.err, '\n'), 1) << finished.err;
    EXPECT_EQ(finished.out, "") << words;
  }
};

TEST_F(Permissions, ToReadAreNeeded) {
  struct Input {
    std::string file, words;
  };
  const Input inputs[] = {{"a.toml", "check a.toml"},
                          {"a.toml", "run a.toml --db b.db"},
                          {"a.db", "report a.db"},
                          {"a.db", "replay a.db 0"},
                          {"layout.json", "import layout layout.json"},
                          {"scenario.json", "simulate scenario.json"},
                          {"scenario.json", "check scenario.json"}};
  for (const auto& [file, words] : inputs) {
    EXPECT_NE(run_unprivileged(words).exit_code, 2) << words << ": allowed, it works";
    std::filesystem::remove(path("b.db"));
    std::filesystem::permissions(path(file), std::filesystem::perms::none);
    expect_refused(words, file);
    std::filesystem::permissions(path(file), std::filesystem::perms(0644));
  }
}

TEST_F(Permissions, ToWriteAreNeeded) {
  const std::pair<std::string, std::string> outputs[] = {{"run a.toml --db locked/b.db", "locked/b.db"},
                                                         {"report a.db -o locked/r.txt", "locked/r.txt"},
                                                         {"generate fishbone -o locked/l.json", "locked/l.json"},
                                                         {"replay a.db 0 --scenario locked/s.json", "locked/s.json"}};
  for (const auto& [words, file] : outputs) {
    EXPECT_NE(run_unprivileged(words).exit_code, 2) << words << ": allowed, it works";
    EXPECT_TRUE(std::filesystem::exists(path(file))) << words;
  }
  std::filesystem::remove_all(path("locked"));
  std::filesystem::create_directory(path("locked"));
  test::give_away(folder_);
  std::filesystem::permissions(path("locked"), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  for (const auto& [words, file] : outputs) expect_refused(words, file);
  EXPECT_TRUE(std::filesystem::is_empty(path("locked")));
  const std::string before = read(path("layout.json"));
  std::filesystem::permissions(path("layout.json"), std::filesystem::perms(0444));
  expect_refused("generate fishbone --seed 9 -o layout.json", "layout.json");
  EXPECT_EQ(read(path("layout.json")), before);
}

}  // namespace
}  // namespace fleetproof::permissions_test
