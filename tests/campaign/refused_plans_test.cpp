// What a campaign file may not say, and the sentence that says so.
#include <gmock/gmock.h>

#include "campaign/plan/campaign_file.hpp"
#include "campaign/plan/plan_check.hpp"
#include "core/base/error.hpp"
#include "generators/scenario_file/radio_trace.hpp"

namespace fleetproof::refused_plans_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string error_of(const CampaignFile& file) {
  try {
    check_plan(file.plan, file.places);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string error_in(const std::string& text) {
  try {
    return error_of(parse_campaign_file(text, "c.toml"));
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string with(const std::string& agents, const std::string& layouts = "\"aisle-grid\"") {
  return "[factors]\nfleet_sizes = [2, 5]\nagents = [" + agents + "]\nlayouts = [" + layouts + "]\n";
}

TEST(RefusedPlans, ANameHasOneLineAndIsNotBlank) {
  EXPECT_EQ(error_in(with("\"reckless\"")), "no error");
  const std::string gate = with("\"reckless\"") + "[[gate]]\nagent = \"reckless\"\n";
  for (const std::string name : {"", "  ", "a\\nb", "a\\u0085b"}) {
    const std::string line = "name = \"" + name + "\"";
    EXPECT_THAT(error_in(with("{ agent = \"reckless\", " + line + " }")),
                testing::AllOf(StartsWith("c.toml:3:"), HasSubstr("factors.agents.name: \""), HasSubstr("a name ")));
    EXPECT_THAT(error_in(line + "\n" + with("\"reckless\"")), StartsWith("c.toml:1:8: name: \"")) << name;
    EXPECT_THAT(error_in(gate + line + "\n"), StartsWith("c.toml:7:8: gate.name: \"")) << name;
  }
}

TEST(RefusedPlans, GatesOfOneAgentHaveTheirOwnNames) {
  const auto gate = [](const std::string& agent) { return "[[gate]]\nagent = \"" + agent + "\"\nname = \"safe\"\n"; };
  const std::string two = with("\"reckless\", \"hull-lock\"");
  EXPECT_EQ(error_in(two + gate("reckless") + gate("hull-lock")), "no error");
  EXPECT_THAT(error_in(two + gate("reckless") + gate("reckless")),
              HasSubstr("gate \"safe\": another gate of \"reckless\" has this name"));
}

TEST(RefusedPlans, AGateHasALimitThatRunsCanMeet) {
  const std::string gate = with("\"reckless\"") + "[[gate]]\nagent = \"reckless\"\nlimit = ";
  EXPECT_EQ(error_in(gate + "0.001\n"), "no error");
  EXPECT_THAT(error_in(gate + "0.0\n"), HasSubstr("limit 0 is refused: no number of runs can demonstrate it"));
}

TEST(RefusedPlans, ARecordingNamesAgvsOfTheFleet) {
  CampaignFile file = parse_campaign_file(with("\"reckless\""), "c.toml");
  const auto record = [&](const std::string& pair) {
    file.plan.radio.trace =
        std::make_shared<const RadioTrace>(parse_radio_trace("sender,receiver,t_send_s,t_recv_s\n" + pair, "r.csv"));
    return error_of(file);
  };
  EXPECT_EQ(record("0,4,1,2\n"), "no error");
  for (const std::string pair : {"0,5,1,2\n", "5,0,1,2\n"}) {
    EXPECT_THAT(record("0,1,1,2\n" + pair),
                HasSubstr("radio.trace names AGV 5, but the largest fleet of this campaign has 5 AGVs, and their "
                          "numbers count from 0"));
  }
}

TEST(RefusedPlans, ValuesAreShownAsTheyAreWritten) {
  EXPECT_THAT(error_in("replicates = 1e12\n" + with("\"reckless\"")),
              HasSubstr("replicates: 1000000000000 is refused: expected a whole number from 1 to 1000000000000, "
                        "written without a point or an exponent"));
  EXPECT_THAT(error_in(with("\"reckless\"") + "[coverage]\nprobes = \"encounter\"\n"),
              HasSubstr("coverage.probes: \"encounter\" is refused: expected an array, as in [\"encounter\"]"));
}

}  // namespace
}  // namespace fleetproof::refused_plans_test
