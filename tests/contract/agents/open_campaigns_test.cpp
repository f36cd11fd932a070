// Campaigns whose transports are open: who may take part, what is drawn, and that they are carried out and judged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/program.hpp"

namespace fleetproof::open_campaigns_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class OpenCampaign : public test::ProgramTest {
 protected:
  static std::string central(const std::string& config = "") {
    std::string path = FLEETPROOF_TALKING_AGENT;
    path.replace(path.find("talking_agent"), std::string_view("talking_agent").size(), "central_agent");
    return "{ vehicle = \"" + path + "\", computer = { file = \"" + path + "\", config = \"" + config + "\" } }";
  }
  void campaign(const std::string& agents, const std::string& world, const std::string& more = "") const {
    write("c.toml", "kind = \"search\"\nseed = 5\nreplicates = 6\nhorizon_s = 600\n[factors]\nagents = [" + agents +
                        "]\nlayouts = [\"random-planar\"]\nfleet_sizes = [1]\nloss = [0.4]\ndelay_s = [2]\n[world]\n" +
                        world + more);
  }
  // Of all runs, as the evidence has it.
  int sum(const std::string& db, const std::string& counter) const {
    run("report " + db + " --evidence " + db + ".d");
    std::istringstream lines(read(path(db + ".d/runs.csv")));
    std::string line;
    std::getline(lines, line);
    const auto fields = [&] {
      std::vector<std::string> found;
      std::istringstream of_line(std::regex_replace(line, std::regex("\"[^\"]*\""), ""));  // commas within a text
      for (std::string field; std::getline(of_line, field, ',');) found.push_back(field);
      return found;
    };
    const std::vector<std::string> names = fields();
    const auto column = std::ranges::find(names, counter) - names.begin();
    EXPECT_LT(column, static_cast<std::ptrdiff_t>(names.size())) << counter;
    int sum = 0;
    while (std::getline(lines, line)) sum += std::stoi(fields().at(static_cast<std::size_t>(column)));
    return sum;
  }
};

TEST_F(OpenCampaign, IsCarriedOutByACentralFleet) {
  campaign(central(), "transports = \"open\"\n");
  for (const char* jobs : {"1", "2", "7"})
    EXPECT_EQ(run("run c.toml --db " + std::string(jobs) + ".db --jobs " + jobs).exit_code, 4) << "it claims nothing";
  EXPECT_EQ(read(path("1.db")), read(path("2.db")));
  EXPECT_EQ(read(path("1.db")), read(path("7.db")));
  EXPECT_THAT(run("verify 1.db --sample 100%").out, HasSubstr("0 differ"));
  EXPECT_GT(sum("1.db", "transports_done"), 12);
  EXPECT_EQ(sum("1.db", "transports_withdrawn"), 0);
  const test::Finished trace = run("replay 1.db 0 --trace");
  EXPECT_THAT(trace.out, HasSubstr("REPRODUCED"));
  EXPECT_THAT(trace.err, HasSubstr("works on"));
  EXPECT_EQ(run("replay 1.db 0 --html r.html").exit_code, 0);
}

// The same transports either way, and the same faults at them.
TEST_F(OpenCampaign, DrawsTheTransportsThatItWouldAssign) {
  const std::string faults = "[faults]\nbreakdowns_per_transport = 0.5\nload_drops_per_transport = 0.5\n";
  const auto scenario = [&](const std::string& agents, const std::string& world) {
    campaign(agents, world, faults);
    run("run c.toml --db c.db --overwrite");
    run("replay c.db 1 --scenario s.json");
    return read(path("s.json"));
  };
  const std::string open = scenario(central(), "transports = \"open\"\n");
  const std::string assigned = scenario(central(), "");
  const auto releases = [](const std::string& text) {
    std::vector<std::string> found;
    for (auto at = text.find("\"release_ns\": "); at != text.npos; at = text.find("\"release_ns\": ", at + 1))
      found.push_back(text.substr(at, text.find_first_of(",}", at) - at));
    return found;
  };
  EXPECT_GT(releases(open).size(), 2U);
  EXPECT_EQ(releases(open), releases(assigned)) << "of one AGV, in its order";
  EXPECT_THAT(open, HasSubstr("\"kind\": \"load-drop\", \"at_ns\""));
  EXPECT_THAT(assigned, HasSubstr("\"kind\": \"load-drop\", \"agv\": \"AGV 0\""));
  EXPECT_THAT(run("check s.json").err, Not(HasSubstr("refused")));
}

TEST_F(OpenCampaign, WithdrawsAShareAndMovesNoOtherDraw) {
  const std::string often = "transports = \"open\"\ntransports_per_agv_hour = 120\n";
  campaign(central(), often + "withdrawn_share = 0.5\n");
  EXPECT_EQ(run("run c.toml --db w.db").exit_code, 4);
  EXPECT_GT(sum("w.db", "transports_withdrawn"), 3);
  campaign(central(), often);
  EXPECT_EQ(run("run c.toml --db c.db").exit_code, 4);
  EXPECT_EQ(sum("w.db", "transports_released"), sum("c.db", "transports_released"));
}

TEST_F(OpenCampaign, AFleetWhoseServerIsDeafIsStuckAsAWhole) {
  campaign(central("deaf"), "transports = \"open\"\n");
  EXPECT_EQ(run("run c.toml --db c.db").exit_code, 4);
  const test::Finished replayed = run("replay c.db 0");
  EXPECT_THAT(replayed.out, HasSubstr("deadlock: from "));
  EXPECT_THAT(replayed.out, HasSubstr("transports 0 of"));
}

TEST_F(OpenCampaign, RefusesWhatCannotBe) {
  const auto refusal = [&](const std::string& agents, const std::string& world) {
    campaign(agents, world);
    const test::Finished checked = run("check c.toml");
    EXPECT_EQ(checked.exit_code, 2) << world;
    return checked.err;
  };
  EXPECT_THAT(refusal("\"hull-lock\"", "transports = \"open\"\n"),
              HasSubstr("\"hull-lock\" carries out assigned transports only"));
  EXPECT_THAT(refusal("\"reckless\"", "transports = \"open\"\n"),
              HasSubstr("name an agent whose computer distributes"));
  const std::string beside = "{ vehicle = \"hull-lock\", computer = \"zone-server\" }";
  EXPECT_THAT(refusal(beside, "transports = \"open\"\n"), HasSubstr("it takes none from a computer"));
  EXPECT_THAT(refusal("\"hull-lock\"", "transports = \"opened\"\n"),
              HasSubstr("expected one of \"assigned\", \"open\""));
  EXPECT_THAT(refusal("\"hull-lock\"", "withdrawn_share = 1.5\n"), HasSubstr("withdrawn_share"));
}

TEST_F(OpenCampaign, AScenarioForAnAgentOnBoardAloneIsRefusedByEachVerb) {
  campaign(central(), "transports = \"open\"\n");
  run("run c.toml --db c.db");
  run("replay c.db 0 --scenario s.json");
  auto scenario = nlohmann::json::parse(read(path("s.json")));
  scenario.erase("computers");
  for (const char* agent : {"hull-lock", "reckless", "no-overhang"}) {
    scenario["agent"] = agent;
    write("alone.json", scenario.dump());
    for (const char* verb : {"check", "simulate", "shrink"}) {
      const test::Finished refused = run(verb + std::string(" alone.json"));
      EXPECT_EQ(refused.exit_code, 2) << verb;
      EXPECT_THAT(refused.err, HasSubstr("carries out assigned transports only")) << verb << " " << agent;
    }
  }
}

}  // namespace
}  // namespace fleetproof::open_campaigns_test
