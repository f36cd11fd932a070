// An agent that cannot start: what is known before the first run is an error, and else the crash says why.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/program.hpp"

namespace fleetproof::start_refusal_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class StartRefusal : public test::ProgramTest {
 protected:
  void write_campaign(const std::string& agent, const std::string& layout, const std::string& config = "") const {
    write("a.toml", "seed = 5\nreplicates = 4\nhorizon_s = 20\nagent_config = \"" + config +
                        "\"\n[factors]\nagents = [\"" + agent + "\"]\nlayouts = [" + layout + "]\nfleet_sizes = [3]\n");
  }
  static std::string on_one_line(const std::string& text) {
    std::istringstream words(text);
    std::string line;
    for (std::string word; words >> word; line += ' ') line += word;
    return line;
  }
  // A square of so many cells a side has 4 n (n - 1) drives.
  void write_square(const std::string& name, int side) const {
    std::string text = "type octile\nheight " + std::to_string(side) + "\nwidth " + std::to_string(side) + "\nmap\n";
    for (int i = 0; i < side; ++i) text += std::string(static_cast<std::size_t>(side), '.') + "\n";
    write(name, text);
  }
};

// The messages of hull-lock have no room for a drive above number 65 534.
TEST_F(StartRefusal, OfALayoutThatIsTooLargeForAnAgentIsAnErrorOfEachVerb) {
  write_square("hall.map", 129);
  for (const std::string agent : {"hull-lock", "timeout-grant", "no-overhang"}) {
    write_campaign(agent, "{ file = \"hall.map\" }");
    for (const std::string verb : {"check a.toml", "run a.toml", "plan a.toml"}) {
      const auto refused = run(verb);
      EXPECT_EQ(refused.exit_code, 2) << verb;
      EXPECT_THAT(refused.err,
                  AllOf(HasSubstr("a.toml:6:"), HasSubstr("factors.agents: layout \"hall\" has 66048 drives; "
                                                          "the messages of agent \"" +
                                                          agent +
                                                          "\" name at most 65535 of each; use a smaller "
                                                          "layout, or another agent")));
      EXPECT_EQ(std::ranges::count(refused.err.substr(refused.err.find("error:")), '\n'), 1) << "one error";
    }
  }
  EXPECT_FALSE(std::filesystem::exists(path("a.db")));
}

TEST_F(StartRefusal, OfAScenarioThatIsTooLargeForAnAgentIsAnErrorOfEachVerb) {
  write_square("hall.map", 129);
  ASSERT_EQ(run("import hall.map -o hall.json").exit_code, 0);
  auto scenario = nlohmann::json::parse(read(test::source("tests/scenarios/figure4.json")));
  scenario["layout"] = nlohmann::json::parse(read(path("hall.json")))["layout"];
  scenario["agent"] = "hull-lock";
  scenario["agvs"] = {{{"name", "A"}, {"start", scenario["layout"]["stations"][0]["name"]}, {"heading", {1, 0}}}};
  write("s.json", scenario.dump());
  for (const std::string verb : {"check s.json", "simulate s.json", "shrink s.json", "explain s.json"}) {
    const auto refused = run(verb);
    EXPECT_EQ(refused.exit_code, 2) << verb << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("s.json: /agent: the scenario has 66048 drives; the messages of agent "
                                       "\"hull-lock\" name at most 65535 of each"))
        << verb;
  }
  const auto other = run("simulate s.json --agent scripted");
  EXPECT_EQ(other.exit_code, 0) << other.err << "an agent without messages has no such limit";
}

// ---- a plug-in says it itself

TEST_F(StartRefusal, OfAPlugInIsFiledWithItsReasonWhereverTheCrashIsTold) {
  write_campaign(FLEETPROOF_FAILING_AGENT, "\"aisle-grid\"", "refuse 1");
  const auto ran = run("run a.toml --db a.db -j 1");
  ASSERT_TRUE(test::has_verdict(ran)) << ran.err;
  const std::string why = "create() returned null: no licence for <12> AGVs\\nin hall 7";
  const std::string whole = run("report a.db").out, head = whole.substr(0, whole.find("Gates (acceptance criteria)"));
  EXPECT_THAT(on_one_line(head), HasSubstr("Its most serious run is 0 (crash: \"agent of AGV 0: " + why + "\"):"));
  EXPECT_THAT(on_one_line(ran.out), HasSubstr(why));
  EXPECT_THAT(run("replay a.db 2").out, AllOf(HasSubstr(why), HasSubstr("at its end: agent of ")));
  EXPECT_THAT(read(path("a.worker-0.log")), HasSubstr("run 2, at its end: agent of AGV 0: " + why + "\n"));
  ASSERT_EQ(run("report a.db --html a.html").exit_code, ran.exit_code);
  EXPECT_THAT(read(path("a.html")), HasSubstr("no licence for &lt;12&gt; AGVs"));
  const auto json = nlohmann::json::parse(run("report a.db --json").out);
  EXPECT_THAT(json.dump(), HasSubstr("no licence for <12> AGVs"));
}

TEST_F(StartRefusal, WithoutAReasonIsFiledAsBefore) {
  write_campaign(FLEETPROOF_FAILING_AGENT, "\"aisle-grid\"", "refuse-silently 1");
  ASSERT_TRUE(test::has_verdict(run("run a.toml --db a.db -j 1")));
  EXPECT_THAT(run("replay a.db 1").out, AllOf(HasSubstr("create() returned null\n"), Not(HasSubstr("null:"))));
}

}  // namespace
}  // namespace fleetproof::start_refusal_test
