// The clock on the wall may be set while a campaign runs. It decides no result, and no budget is longer or shorter.
#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::clock_test {
namespace {

using testing::HasSubstr;

class FalseClock : public test::ProgramTest, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("c.toml",
          std::string("kind = \"search\"\nseed = 5\nreplicates = 100\nhorizon_s = 60\n[factors]\nagents = [\"") +
              FLEETPROOF_PLUGIN + "\", \"reckless\"]\nlayouts = [\"aisle-grid\"]\nloss = [0.4]\ndelay_s = [2]\n");
  }
  test::Finished run_with_false_clock(const std::string& words) const {
    return shell(std::string("LD_PRELOAD='") + FLEETPROOF_FALSE_CLOCK + "' FLEETPROOF_TEST_CLOCK=" + GetParam() +
                 " \"$FLEETPROOF\" " + words);
  }
  std::string time_in_session_log(const std::string& name, const std::string& key) const {
    std::ifstream file(path(name));
    for (std::string line; std::getline(file, line);) {
      if (const auto json = nlohmann::json::parse(line); json.contains(key)) return json[key];
    }
    return "none";
  }
  // Else the test is about nothing.
  void expect_false_times_in(const std::string& name) const {
    const std::string begun = time_in_session_log(name, "started_utc"), ended = time_in_session_log(name, "ended_utc");
    const std::string how = GetParam();
    EXPECT_TRUE(how == "back" ? ended < begun : how == "forward" ? ended > begun : ended == begun) << begun << ended;
    EXPECT_NE(begun.substr(0, 4), "none");
  }
};

TEST_P(FalseClock, ChangesNoResult) {
  EXPECT_EQ(run("run c.toml --db true.db").exit_code, 4);
  EXPECT_EQ(run_with_false_clock("run c.toml --db false.db").exit_code, 4);
  EXPECT_GT(read(path("true.db")).size(), 50'000U);
  EXPECT_TRUE(read(path("true.db")) == read(path("false.db")));
  expect_false_times_in("false.sessions.jsonl");
}

// Were the budget measured on the wall, the campaign would end at once or never.
TEST_P(FalseClock, LeavesABudgetItsLength) {
  const auto begin = std::chrono::steady_clock::now();
  const auto finished = run_with_false_clock("run c.toml --replicates 10000000 --db long.db --max-time 3s");
  EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
  EXPECT_EQ(finished.exit_code, 4) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr("stopped early"));
  expect_false_times_in("long.sessions.jsonl");
}

INSTANTIATE_TEST_SUITE_P(, FalseClock, testing::Values("back", "forward", "frozen"),
                         [](const auto& how) { return std::string(how.param); });

}  // namespace
}  // namespace fleetproof::clock_test
