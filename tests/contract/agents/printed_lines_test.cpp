// What agents print is kept in the logs of the workers: each line names its run, and replay quotes the run's own.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/program.hpp"

namespace fleetproof::printed_lines_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class PrintedLines : public test::ProgramTest {
 protected:
  void write_campaign(const std::string& name, const std::string& config) const {
    write(name, "seed = 5\nreplicates = 6\nhorizon_s = 60\nagent_config = \"" + config + "\"\n[factors]\nagents = [\"" +
                    FLEETPROOF_FAILING_AGENT + "\"]\nlayouts = [\"aisle-grid\"]\nfleet_sizes = [3]\n");
  }
  std::vector<std::string> lines_of(const std::string& log) const {
    std::istringstream text(read(path(log)));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }
};

TEST_F(PrintedLines, NameTheirRunTheirAgvAndTheSimulatedTime) {
  write_campaign("a.toml", "print 1");
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db -j 1")));
  const auto lines = lines_of("a.worker-0.log");
  ASSERT_GE(lines.size(), 6U);
  for (const std::string& line : lines)
    EXPECT_THAT(line,
                testing::MatchesRegex("run [0-5], AGV [0-2], [0-9]+\\.[0-9]{3} s: failing: hello from the agent"));
}

TEST_F(PrintedLines, AreThoseOfTheLastCampaignAlone) {
  write_campaign("a.toml", "print 1");
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db -j 1")));
  const auto before = lines_of("a.worker-0.log");
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db -j 1 --overwrite")));
  EXPECT_EQ(lines_of("a.worker-0.log"), before) << "cut, and written again";
  EXPECT_FALSE(std::filesystem::exists(path("a.worker-1.log")));
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db -j 1 --replicates 8")));
  EXPECT_GT(lines_of("a.worker-0.log").size(), before.size()) << "a campaign that goes on writes on";
}

TEST_F(PrintedLines, AreQuotedByReplayForTheRunThatPrintedThem) {
  write_campaign("a.toml", "segfault 1");
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db -j 1")));
  const auto told = run("replay a.db 3");
  EXPECT_THAT(told.out, AllOf(HasSubstr("the last that its agents printed in the campaign (a.worker-0.log)"),
                              HasSubstr("failing_agent"), Not(HasSubstr("run 2"))));
  EXPECT_THAT(read(path("a.worker-0.log")), HasSubstr("\nrun 3, at its end: "));
  const auto json = nlohmann::json::parse(run("replay a.db 3 --json").out);
  EXPECT_EQ(json.at("printed").at("log"), "a.worker-0.log");
  EXPECT_LE(json.at("printed").at("lines").size(), 40U);
  write_campaign("b.toml", "");
  ASSERT_TRUE(test::has_verdict(run("run b.toml --db b.db -j 1")));
  EXPECT_THAT(run("replay b.db 3").out, Not(HasSubstr("printed"))) << "nothing was";
}

// Each shard writes beside its own session; the results file is put together elsewhere.
TEST_F(PrintedLines, AreFoundAfterTheShardsArePutTogether) {
  write_campaign("a.toml", "print 1");
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db whole.db -j 1")));
  for (const std::string shard : {"1/2", "2/2"})
    ASSERT_TRUE(test::has_verdict(run("run a.toml -j 1 --out shards --shard " + shard)));
  ASSERT_TRUE(test::has_verdict(run("merge shards --db a.db")));
  const auto printed = [&](const std::string& replay) {
    return nlohmann::json::parse(run(replay + " --json").out).at("printed");
  };
  for (const std::string run_index : {"0", "3", "5"}) {
    const auto of_shard = printed("replay a.db " + run_index);
    EXPECT_THAT(of_shard.at("log").get<std::string>(), testing::StartsWith("a.worker-"));
    EXPECT_EQ(of_shard.at("lines"), printed("replay whole.db " + run_index).at("lines"));
  }
  ASSERT_TRUE(test::has_verdict(run("merge shards --db a.db --overwrite")));
  EXPECT_FALSE(std::filesystem::exists(path("a.worker-2.log"))) << "those of the earlier merge are gone";
  // What else has the name of a log is neither waited for nor told.
  const auto shell_result = shell(
      "rm shards/sessions/*.worker-0.log; for s in shards/sessions/*.sessions.jsonl; do "
      "mkfifo \"${s%.sessions.jsonl}.worker-0.log\"; done");
  ASSERT_EQ(shell_result.exit_code, 0) << shell_result.err;
  EXPECT_TRUE(test::has_verdict(run("merge shards --db a.db --overwrite")));
}

}  // namespace
}  // namespace fleetproof::printed_lines_test
