#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::wreck_test {
namespace {

class Wreck : public test::ProgramTest {};

// An AGV hits an obstacle just after it has left its station, and its computer restarts. It then knows only the station
// that it left and a position that may be wrong by more than it has driven. Another AGV wants to come near.
TEST_F(Wreck, BesideItsStationDoesNotTakeItselfForStandingThere) {
  for (const std::string words :
       {"wreck_beside_its_station.json'", "wreck_within_position_error.json' --agent-config position_error_m=0.5"}) {
    const auto finished = run("simulate '" + test::source("tests/scenarios/") + words + " --agent hull-lock --json");
    const auto json = nlohmann::json::parse(finished.out, nullptr, false);
    ASSERT_TRUE(json.is_object()) << finished.err;
    ASSERT_FALSE(json["violations"].empty()) << "the obstacle is hit";
    for (const auto& violation : json["violations"]) EXPECT_EQ(violation["entity_kinds"], "AGV-obstacle") << violation;
  }
}

}  // namespace
}  // namespace fleetproof::wreck_test
