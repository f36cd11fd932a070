#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof {
namespace {

using testing::HasSubstr;

constexpr const char* kCampaign = R"(
name = "a"
seed = 11
replicates = 2
horizon_s = 60
[factors]
agents = ["hull-lock", "timeout-grant"]
layouts = ["aisle-grid"]
loss = [0.4]
delay_s = [2]
[world]
transports_per_agv_hour = 60
)";

class ShrinkVerb : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("a.toml", kCampaign);
    run("run a.toml --db a.db");
    for (int index : {1, 3}) {
      if (run("replay a.db " + std::to_string(index) + " --scenario case.json").out.find("contact") ==
          std::string::npos)
        continue;
      failing_ = std::to_string(index);
      return;
    }
    FAIL() << "no run of timeout-grant fails";
  }
  std::string failing_;
};

TEST_F(ShrinkVerb, TheCaseIsAFileThatSimulatePlays) {
  const auto shrunk = run("shrink a.db " + failing_ + " -o small.json --max-trials 40000 --max-time 600");
  ASSERT_EQ(shrunk.exit_code, 0) << shrunk.err;
  EXPECT_THAT(shrunk.out, HasSubstr("  after:  "));
  EXPECT_THAT(shrunk.out, HasSubstr("fleetproof simulate small.json"));
  const auto small = nlohmann::json::parse(read(path("small.json")));
  EXPECT_EQ(small["agent"], "timeout-grant");
  EXPECT_LE(small["agvs"].size(), 3U);
  EXPECT_EQ(small["radio"]["loss"], 0.0);
  const auto played = run("simulate small.json");
  EXPECT_EQ(played.exit_code, 1);
  EXPECT_THAT(played.out, HasSubstr("as expected: contact"));
  const auto json = nlohmann::json::parse(run("simulate small.json --json").out);
  EXPECT_TRUE(json["expected"]["same_run"]);
  EXPECT_THAT(run("simulate small.json --agent hull-lock").out, HasSubstr("NOT as expected"));
}

TEST_F(ShrinkVerb, AFileIsShrunkLikeItsRun) {
  const auto of_run = run("shrink a.db " + failing_ + " -o one.json --json --max-trials 1500");
  const auto of_file = run("shrink case.json -o two.json --json --max-trials 1500");
  ASSERT_EQ(of_file.exit_code, 0) << of_file.err;
  auto one = nlohmann::json::parse(of_run.out), two = nlohmann::json::parse(of_file.out);
  EXPECT_EQ(one["after"], two["after"]);
  EXPECT_EQ(one["trials"], two["trials"]);
  EXPECT_EQ(read(path("one.json")), read(path("two.json")));
}

// Software that crashes costs one candidate.
TEST_F(ShrinkVerb, APlugInIsShrunkInWorkers) {
  std::string alone = kCampaign;
  alone.replace(alone.find("loss ="), 0, "fleet_sizes = [1]\n");
  write("alone.toml", alone);
  run("run alone.toml --db alone.db");
  ASSERT_EQ(run("replay alone.db 0 --scenario alone.json").exit_code, 0);
  const std::string plugin = std::string(" --agent '") + FLEETPROOF_FAILING_AGENT + "'";
  const auto shrunk = run("shrink alone.json -o small.json --max-trials 900 --agent-config 'segfault 1'" + plugin);
  ASSERT_EQ(shrunk.exit_code, 0) << shrunk.err;
  EXPECT_THAT(shrunk.out, HasSubstr("crash\n"));
  const auto small = nlohmann::json::parse(read(path("small.json")));
  EXPECT_EQ(small["agent_config"], "segfault 1");
  EXPECT_EQ(small["expected"]["failure"], "crash");
  EXPECT_LT(small["horizon_ns"], 60'000'000'000);
}

TEST_F(ShrinkVerb, BadWordsAreRefused) {
  const std::string passing = failing_ == "1" ? "0" : "2";
  const auto refused = [&](const std::string& words, const std::string& sentence) {
    const auto finished = run("shrink " + words);
    EXPECT_EQ(finished.exit_code, 2) << words;
    EXPECT_THAT(finished.err, HasSubstr(sentence)) << words;
  };
  refused("a.db " + passing, "does not fail");
  refused("a.db 4", "does not exist");
  refused("a.db x", "no run index");
  refused("a.db 1 --agent reckless", "a run has its agent");
  refused("nothing.json", "nothing.json");
  write("letter.json", "{\"a\": 1}");
  refused("a.db " + failing_ + " -o letter.json", "is not a scenario file");
  EXPECT_EQ(read(path("letter.json")), "{\"a\": 1}");
}

}  // namespace
}  // namespace fleetproof
