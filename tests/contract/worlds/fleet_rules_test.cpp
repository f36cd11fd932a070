// What a layout permits, and a fleet or script that asks for something else: refused by name, at its place.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof::fleet_rules_test {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class FleetRules : public test::ProgramTest {
 protected:
  // Three stations in a row, joined both ways; `permissions` of the second segment.
  static std::string layout(const std::string& permissions, const std::string& more = "") {
    return R"({"name": "plant", "stations": [{"name": "a", "position_m": [0, 0]}, {"name": "b", "position_m": [6, 0]},
      {"name": "c", "position_m": [12, 0]}], "segments": [{"from": "a", "to": "b", "bidirectional": true)" +
           more + R"(},
      {"from": "b", "to": "c", "bidirectional": true, "permissions": [)" +
           permissions + R"(]}]})";
  }
  test::Finished checked(const std::string& permissions, const std::string& fleet) const {
    write("plant.json", R"({"version": 1, "layout": )" + layout(permissions) + "}");
    write(
        "c.toml",
        "horizon_s = 1\n[factors]\nagents = [\"hull-lock\"]\nlayouts = [\"plant.json\"]\nfleet_sizes = [1]\n" + fleet);
    return run("check c.toml");
  }
};

TEST_F(FleetRules, ATypeThatIsMisspelledIsNamed) {
  const auto finished = checked(R"({"vehicle_type": "tuger"})", "[vehicle]\nname = \"tugger\"\n");
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err,
              AllOf(HasSubstr("c.toml:6"), HasSubstr("layout \"plant\": segment \"b-c\" is for vehicle type "
                                                     "\"tuger\", which this fleet does not have "
                                                     "(\"tugger\"); did you mean \"tugger\"?")));
}

TEST_F(FleetRules, ATypeOfAnotherFleetIsToldAndAllowed) {
  const std::string both = R"({"vehicle_type": "tugger-1"}, {"vehicle_type": "tugger-2"})";
  const auto finished = checked(both, "[vehicle]\nname = \"tugger-1\"\n");
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.err,
              HasSubstr("warning: layout \"plant\": segment \"b-c\" is for vehicle type \"tugger-2\", which "
                        "this fleet does not have (\"tugger-1\")\n"));
  EXPECT_THAT(checked(R"({"vehicle_type": "tugger-1"})", "[vehicle]\nname = \"tugger-1\"\n").err,
              Not(HasSubstr("does not have")));
}

TEST_F(FleetRules, AFleetWithoutAWayIsToldWhichTypesHaveOne) {
  const auto finished = checked(R"({"vehicle_type": "forklift"})", "");
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err,
              HasSubstr("permissions name \"forklift\", which this fleet does not have (\"pallet-agv\")"));
}

TEST_F(FleetRules, AFleetThatFillsTheFloorIsToldBeforeTheCampaign) {
  const auto told = [&](const std::string& verb, int fleet) {
    const std::string factors = "agents = [\"hull-lock\"]\nlayouts = [\"plant/20\"]\nfleet_sizes = [";
    write("c.toml", "horizon_s = 1\nreplicates = 1\n[factors]\n" + factors + std::to_string(fleet) + "]\n");
    return run(verb).err;
  };
  const char* crowded =
      "warning: \"plant/20\": 11 AGVs on 20 stations; with more than one for two stations, 10 here, a "
      "fleet may stand still\n";
  for (const char* verb : {"check c.toml", "run c.toml --db c.db", "run c.toml --shard 1/1 --out shards", "plan c.toml",
                           "sensitivity c.toml --runs 1 --agent asks-once"})
    EXPECT_THAT(told(verb, 11), HasSubstr(crowded)) << verb;
  EXPECT_THAT(told("check c.toml", 10), Not(HasSubstr("stand still")));
}

TEST_F(FleetRules, APlantTooSmallForItsKnobIsToldBeforeTheCampaign) {
  const auto told = [&](const std::string& layout, int fleet) {
    write("c.toml", "horizon_s = 1\nreplicates = 1\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"" + layout +
                        "\"]\nfleet_sizes = [" + std::to_string(fleet) + "]\n");
    return run("check c.toml");
  };
  EXPECT_THAT(
      told("plant/four-way", 1).err,
      HasSubstr("warning: \"plant/four-way\": a plant of 40 stations cannot contain \"four-way\"; ask for 80 or "
                "more, as in \"plant/four-way/80\"\n"));
  EXPECT_THAT(told("plant/79/four-way", 9).err, HasSubstr("a plant of 79 stations cannot contain \"four-way\""));
  EXPECT_THAT(run("generate plant/four-way/79").err,
              HasSubstr("warning: a plant of 79 stations cannot contain \"four-way\"; ask for 80 or more"));
  EXPECT_THAT(told("plant/four-way", 2).err, Not(HasSubstr("cannot contain")));
  EXPECT_THAT(told("plant/four-way/80", 1).err, Not(HasSubstr("cannot contain")));
  EXPECT_THAT(run("generate plant/four-way/80").err, Not(HasSubstr("cannot contain")));
}

// The number that fits is one with which the fleet can move.
TEST_F(FleetRules, AFleetWithoutRoomIsRefusedAtItsPlace) {
  write("c.toml",
        "horizon_s = 1\nreplicates = 1\n[factors]\nagents = [\"reckless\"]\nlayouts = [\"plant/20\"]\n"
        "fleet_sizes = [2, 30]\n");
  for (const char* verb : {"check c.toml", "plan c.toml", "sensitivity c.toml --runs 1 --agent asks-once",
                           "run c.toml --db c.db", "run c.toml --shard 1/1 --out shards"}) {
    const auto refused = run(verb);
    EXPECT_EQ(refused.exit_code, 2) << verb;
    EXPECT_THAT(refused.err, HasSubstr("c.toml:6:15: factors.fleet_sizes: cannot place 30 AGVs on \"plant/20\""))
        << verb;
    EXPECT_THAT(refused.err,
                HasSubstr("19 fit on \"plant/20\", but with more than one for two stations a fleet may stand "
                          "still: ask for 10 or fewer, or for a larger layout\n"))
        << verb;
  }
}

// The first floor that is drawn has room for the fleet, most of the others have not.
TEST_F(FleetRules, AFleetForWhichOtherFloorsHaveNoRoomIsToldBeforeTheCampaign) {
  write("c.toml",
        "kind = \"search\"\nseed = 13\nhorizon_s = 1\nreplicates = 40\n[factors]\nagents = [\"reckless\"]\nlayouts = "
        "[\"corridor-sidings\"]\nfleet_sizes = [35]\n");
  for (const char* verb : {"check c.toml", "run c.toml --db c.db"}) {
    const auto finished = run(verb);
    EXPECT_EQ(finished.exit_code == 2, false) << finished.err;
    EXPECT_THAT(finished.err,
                ContainsRegex("warning: \"corridor-sidings\": no room for 35 AGVs in [0-9]+ of the first 16 "
                              "worlds, but for [0-9]+; the runs there end without a result\n"))
        << verb;
  }
  const auto crowded = run("report c.db --json").out;
  EXPECT_THAT(crowded, HasSubstr("cannot place 35 AGVs"));
}

TEST_F(FleetRules, OrdersBetweenStationsThatAreNotForStorageAreTold) {
  EXPECT_THAT(
      checked("", "").out,
      HasSubstr("in 1 of these worlds, orders lead between stations that are not for storage: AGVs cannot pick at one "
                "storage station and drop at another\n"));
  EXPECT_THAT(checked("", "[world]\ntransports_per_agv_hour = 0\n").out, Not(HasSubstr("orders lead")));
  write("plant.csv",
        "id,x,y,purposes\na,0,0,storage\nb,6,0,storage\nc,12,0,routing\nfrom,to,bidirectional\na,b,false\nb,c,true\n");
  const auto core = run("import csv plant.csv --core-only");
  EXPECT_EQ(core.exit_code, 0) << core.err;
  EXPECT_THAT(core.err, HasSubstr("plant.csv: 1 of 2 storage stations are left; with fewer than 2, orders lead between "
                                  "other stations\n"));
}

// Permissions that only some types have are no reason to cut stations off.
TEST_F(FleetRules, TheRemedyIsOneThatHelps) {
  EXPECT_THAT(
      checked(R"({"vehicle_type": "forklift"})", "").err,
      AllOf(HasSubstr("cut off: \"c\""), HasSubstr("lift these permissions (any_type)"), Not(HasSubstr("core_only"))));
}

TEST_F(FleetRules, AScenarioNamesTheTypeAtItsLine) {
  const auto scenario = [&](const std::string& type) {
    write("s.json",
          "{\"version\": 1, \"layout\": " + layout(R"({"vehicle_type": ")" + type + "\"}") +
              ",\n\"vehicle_types\": [{\"name\": \"tugger\"}], \"agvs\": [{\"name\": \"A\", \"start\": \"a\"}]}");
    return run("check s.json");
  };
  EXPECT_EQ(scenario("tugger").exit_code, 0) << scenario("tugger").err;
  const auto finished = scenario("tuger");
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("s.json:3: /layout/segments/1/permissions/0/vehicle_type: \"tuger\""),
                                  HasSubstr("did you mean \"tugger\"?")));
}

// Nothing is nearly alike here, or the type that is has a lane of its own.
TEST_F(FleetRules, AScenarioIsWarnedOfATypeThatItDoesNotHave) {
  write("s.json",
        "{\"version\": 1, \"layout\": " + layout(R"({"vehicle_type": "crane"})") +
            ",\n\"vehicle_types\": [{\"name\": \"tugger\"}], \"agvs\": [{\"name\": \"A\", \"start\": \"a\"}]}");
  const auto checked = run("check s.json");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.err, HasSubstr("is for vehicle type \"crane\", which this fleet does not have (\"tugger\")"));
}

TEST_F(FleetRules, AScriptThatDrivesBackwardNeedsALaneForIt) {
  const auto scenario = [&](const std::string& travel, const std::string& start, const std::string& segment) {
    write("s.json", "{\"version\": 1, \"layout\": " + layout("", travel) +
                        ",\n\"agvs\": [{\"name\": \"A\", \"start\": \"" + start +
                        "\", \"script\": [\n{\"at_s\": 1, \"action\": \"move\", \"segment\": \"" + segment +
                        "\", \"backward\": true}]}]}");
    return run("check s.json");
  };
  const std::string back = R"(, "back_travel": "either")";
  EXPECT_EQ(scenario(back, "b", "a-b").exit_code, 0) << scenario(back, "b", "a-b").err;
  const auto from_a = scenario(back, "a", "a-b");
  EXPECT_EQ(from_a.exit_code, 2);
  EXPECT_THAT(
      from_a.err,
      HasSubstr("s.json:5: /agvs/0/script/0/backward: true is refused: \"A\" cannot drive segment \"a-b\" backward "
                "from \"a\"; leave backward out, or set travel of the segment to backward or either"));
  EXPECT_THAT(scenario("", "b", "a-b").err, HasSubstr("or set back_travel of the segment"));
  EXPECT_THAT(scenario("", "a", "b-c").err,
              HasSubstr("\"A\" cannot drive segment \"b-c\" backward; leave backward out"));
}

// The vehicles of a file, in a campaign on its layout.
TEST_F(FleetRules, VehiclesOfAFileAreAFleet) {
  const std::string campaign = "horizon_s = 1\n[factors]\nagents = [\"hull-lock\"]\nfleet_sizes = [1]\nlayouts = [\"";
  const auto today = test::source("tests/survey/files/today.xml"),
             rules = test::source("tests/survey/files/rules.lif.json");
  const auto drawn = run("import opentcs '" + today + "' --vehicles fleet.toml -o layout.json");
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_EQ(read(path("fleet.toml")), "# vehicles of " + today +
                                          "\n\n[[vehicle]]\nname = \"V 1\"\nlength_m = 1.4\nwidth_m = 0.7\n"
                                          "centre_ahead_m = 0.2\nspeed_mps = 1.2\nreverse_speed_mps = 0.4\n");
  EXPECT_THAT(drawn.err, HasSubstr("vehicle details are left out (\"height\", \"energyLevelCritical\")"));
  write("c.toml", campaign + today + "\"]\n" + read(path("fleet.toml")));
  const auto checked = run("check c.toml");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;

  write("sheet.json", R"({"typeSpecification": {"seriesName": "fork"}, "physicalParameters": {"speedMax": 1.5,
    "accelerationMax": 0.5, "decelerationMax": 0.9, "length": 1.3, "width": 0.8}})");
  const auto beside = run("import lif '" + rules + "' --factsheet sheet.json --vehicles fork.toml -o layout.json");
  EXPECT_EQ(beside.exit_code, 0) << beside.err;
  EXPECT_THAT(read(path("fork.toml")), HasSubstr("name = \"fork\"\nlength_m = 1.3\nwidth_m = 0.8\nspeed_mps = 1.5\n"));
  EXPECT_THAT(run("import lif '" + rules + "' --vehicles fork.toml").err, HasSubstr("name their VDA 5050 factsheet"));
  EXPECT_THAT(run("import lif '" + rules + "' --factsheet sheet.json").err, HasSubstr("given without --vehicles"));
  EXPECT_THAT(run("import opentcs '" + today + "' --vehicles layout.json -o l.json").err, HasSubstr("--vehicles"));
}

}  // namespace
}  // namespace fleetproof::fleet_rules_test
