// What a layout permits, and a fleet or script that asks for something else: refused by name, at its place.
#include <gmock/gmock.h>

#include "tests/support/program.hpp"

namespace fleetproof {
namespace {

using testing::AllOf;
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

}  // namespace
}  // namespace fleetproof
