// The standard campaign as a file to start from.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof::new_campaign_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class NewCampaign : public test::ProgramTest {
 protected:
  static std::string standard(const std::string& name) { return read(test::source("tests/campaigns/" + name)); }
};

TEST_F(NewCampaign, IsTheStandardCampaignAndCanBeRunAtOnce) {
  const auto finished = run("new campaign night.toml");
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("fleetproof run night.toml"));
  EXPECT_EQ(read(path("night.toml")), standard("standard.toml"));
  EXPECT_EQ(read(path("long-haul.json")), standard("long-haul.json"));
  EXPECT_EQ(run("check night.toml").exit_code, 0);
  ASSERT_EQ(run("new campaign --short").exit_code, 0) << "the layout is there already";
  EXPECT_EQ(read(path("campaign.toml")), standard("standard-short.toml"));
  EXPECT_EQ(run("check campaign.toml").exit_code, 0);
}

// Its worlds are those of the usual campaign, but for who hears of the transports.
TEST_F(NewCampaign, HasACentralCounterpart) {
  for (const std::string length : {"", " --short"}) {
    const std::string file = length.empty() ? "night.toml" : "short.toml";
    ASSERT_EQ(run("new campaign " + file + " --central" + length).exit_code, 0);
    const std::string text = read(path(file));
    for (const char* line : {"\"zone-server\" }]\n", "-central\"\n", "\n[[computers]]\n", "\ntransports = \"open\""})
      EXPECT_THAT(text, HasSubstr(line)) << file;
    EXPECT_THAT(text, Not(HasSubstr("hull-lock\""))) << file;
    const auto checked = run("check " + file);
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
  }
  EXPECT_THAT(read(path("night.toml")), HasSubstr("agent = \"zone-server+follower\"\n"));
  EXPECT_EQ(run("run short.toml --central").exit_code, 2);
}

TEST_F(NewCampaign, OverwritesNothing) {
  write("mine.toml", "seed = 1\n");
  const auto refused = run("new campaign mine.toml");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("mine.toml: is there already, with another content"));
  EXPECT_EQ(read(path("mine.toml")), "seed = 1\n");
  EXPECT_FALSE(std::filesystem::exists(path("long-haul.json"))) << "nothing was begun";
  write("long-haul.json", "{}");
  EXPECT_EQ(run("new campaign").exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("campaign.toml")));
  EXPECT_EQ(run("new campaign no/such/folder/a.toml").exit_code, 2);
  EXPECT_EQ(run("new world").exit_code, 2);
  std::filesystem::remove(path("long-haul.json"));
  EXPECT_THAT(run("new campaign long-haul.json").err, HasSubstr("long-haul.json: ends in .json"));
  EXPECT_FALSE(std::filesystem::exists(path("long-haul.json"))) << "its layout has this name";
}

using NewAgent = test::ProgramTest;

// What it writes is built and run in ../agents/package_test.cpp.
TEST_F(NewAgent, RefusesWhatDoesNotExist) {
  const auto refused = [&](const std::string& words, const std::string& sentence) {
    const auto finished = run("new " + words);
    EXPECT_EQ(finished.exit_code, 2) << words;
    EXPECT_THAT(finished.err, HasSubstr(sentence)) << words;
  };
  refused("agent", "NAME: is missing");
  refused("agent 3x", "\"3x\" is no name for an agent");
  refused("agent a/b", "\"a/b\" is no name for an agent");
  refused("agent hull-lock", "hull-lock is an agent of fleetproof list agents");
  refused("agent mine --language pyhton", "did you mean \"python\"?");
  refused("agent mine --language rust", "known: cpp, c, python; every other language: the page lockstep.md");
  refused("agent mine --language c --style straight", "there is no start \"straight\" in c; known: callbacks, master");
  refused("agent mine --central", "fleetproof new agent NAME --style master");
  refused("campaign c.toml --language c", "--language: is for an agent");
  EXPECT_FALSE(std::filesystem::exists(path("mine")));
  std::filesystem::create_directory(path("mine"));
  write("mine/mine.toml", "seed = 1\n");
  refused("agent mine", "mine/mine.toml: is there already, with another content");
  EXPECT_FALSE(std::filesystem::exists(path("mine/agent.cpp"))) << "all or none";
  write("full", "");
  refused("agent full", "full");
}

// The names of the starts are replaced everywhere.
TEST_F(NewAgent, BearsItsNameOnly) {
  for (const char* words : {"cpp --style master", "python --style master", "c", "cpp --style straight"}) {
    std::filesystem::remove_all(path("mine"));
    ASSERT_EQ(run(std::string("new agent mine --language ") + words).exit_code, 0) << words;
    ASSERT_EQ(run(std::string("new agent mine --language ") + words).exit_code, 0) << "twice the same";
    for (const auto& file : std::filesystem::directory_iterator(path("mine"))) {
      const std::string text = read(file.path());
      EXPECT_THAT(text, HasSubstr("mine")) << file.path();
      for (const char* left : {"my-agent", "my-master", "depot", "@PROGRAM@"})
        EXPECT_THAT(text, Not(HasSubstr(left))) << file.path();
    }
  }
}

}  // namespace
}  // namespace fleetproof::new_campaign_test
