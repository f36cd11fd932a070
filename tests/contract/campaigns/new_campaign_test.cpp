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

}  // namespace
}  // namespace fleetproof::new_campaign_test
