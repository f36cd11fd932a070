#include <gmock/gmock.h>
#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::shrink_verb_test {
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
  // The command that it prints finds the agent.
  const auto at = shrunk.out.find("fleetproof simulate small.json --plugin ");
  ASSERT_NE(at, std::string::npos) << shrunk.out;
  const auto played = run(shrunk.out.substr(at + 11, shrunk.out.find('\n', at) - at - 11));
  EXPECT_THAT(played.out, HasSubstr("as expected: crash")) << played.err;
  for (const std::string verb : {"simulate", "shrink"})
    EXPECT_THAT(run(verb + " small.json").err, HasSubstr("small.json: /agent: agent \"failing\" is not known"));
}

// What is said of a run is not said of other software without a word.
TEST_F(ShrinkVerb, ARebuiltPlugInIsNamedFirst) {
  std::filesystem::copy(FLEETPROOF_FAILING_AGENT, path("mine.so"));
  std::string mine = kCampaign;
  mine.replace(mine.find("[\"hull-lock\", \"timeout-grant\"]"), 30, "[\"./mine.so\"]");
  mine.replace(mine.find("loss ="), 0, "fleet_sizes = [1]\n");
  write("mine.toml", mine);
  run("run mine.toml --db mine.db");
  EXPECT_THAT(read(path("mine.sessions.jsonl")),
              HasSubstr("\"file\":\"" + std::filesystem::canonical(path("mine.so")).string() + "\""));
  const std::string told = "mine.so is not the one of the campaign (stored ";
  const auto words = {"verify mine.db", "replay mine.db 0", "shrink mine.db 0 --max-time 1", "findings mine.db"};
  for (const std::string each : words) EXPECT_THAT(run(each).err, testing::Not(HasSubstr(told))) << each;
  std::ofstream(path("mine.so"), std::ios::app) << "another build";
  for (const std::string each : words) EXPECT_THAT(run(each).err, HasSubstr(told)) << each;
}

// A search with less time must not undo what one with more time has found.
TEST_F(ShrinkVerb, ASmallerCaseOfTheSameFailureStays) {
  const std::string shrink = "shrink a.db " + failing_ + " -o small.json";
  ASSERT_EQ(run(shrink + " --max-trials 3000 --max-time 600").exit_code, 0);
  const std::string small = read(path("small.json"));
  std::filesystem::remove(path("small.json.trials"));
  const auto again = run(shrink + " --max-trials 10");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read(path("small.json")), small);
  EXPECT_THAT(again.out, HasSubstr("an earlier search has found this case"));
  EXPECT_THAT(again.out, HasSubstr("; give more --max-trials"));
  // Of another failure, or of other software, it is no result.
  std::string of_other = small;
  const std::string own_word = "\"timeout-grant\"";
  write("small.json", of_other.replace(of_other.find(own_word), own_word.size(), "\"reckless\""));
  std::filesystem::remove(path("small.json.trials"));
  EXPECT_THAT(run(shrink + " --max-trials 10").out, testing::Not(HasSubstr("an earlier search")));
  write("small.json", read(path("case.json")));
  ASSERT_EQ(run(shrink + " --max-trials 300").exit_code, 0);
  EXPECT_NE(read(path("small.json")), read(path("case.json")));
}

// What many trials in old processes have found does not fail in fresh ones: it is refused, and no file is left.
TEST_F(ShrinkVerb, WhatDoesNotFailAgainIsNoSmallestCase) {
  const std::size_t agvs = nlohmann::json::parse(read(path("case.json")))["agvs"].size();
  ASSERT_GT(agvs, 2U);
  const std::string agent = std::string(" --agent '") + FLEETPROOF_UNSTEADY_AGENT + "' --agent-config aged-" +
                            std::to_string(agvs) + " --max-trials 300 --jobs 1";
  for (const std::string verb : {"shrink", "explain"}) {
    const auto refused = run(verb + " case.json" + agent + (verb == "shrink" ? " -o small.json" : " --max-time 60"));
    EXPECT_EQ(refused.exit_code, 2) << verb << refused.out;
    EXPECT_THAT(refused.err, HasSubstr("has no smaller case that always fails so: 0 of 10 repetitions")) << verb;
    EXPECT_THAT(refused.err, HasSubstr("Its agent does not always do the same")) << verb;
  }
  for (const char* left : {"small.json", "small.json.trials"})
    EXPECT_FALSE(std::filesystem::exists(path(left))) << left;
}

// As if the software had failed with another pair in the campaign.
TEST_F(ShrinkVerb, AnotherFailureThanTheStoredOneIsRefused) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path("a.db").c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db, "UPDATE violations SET entity_b = entity_b + 40", nullptr, nullptr, nullptr), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db, "UPDATE runs SET agv_count = 50", nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(db);
  for (const std::string verb : {"shrink", "explain"}) {
    const auto refused = run(verb + " a.db " + failing_ + " --max-trials 10");
    EXPECT_EQ(refused.exit_code, 2) << refused.out;
    EXPECT_THAT(refused.err,
                testing::ContainsRegex("failed in the campaign with contact.* \\(bodies [0-9]+ and 4[0-9]\\); "
                                       "0 of 10 repetitions in fresh processes failed so \\(10: contact"));
    EXPECT_THAT(refused.err, HasSubstr("the software differs, or does not always do the same; the campaign has no "
                                       "recording of what it did"));
  }
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
}  // namespace fleetproof::shrink_verb_test
