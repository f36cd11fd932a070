// An agent in straight-line code (tests/examples/carrier.cpp) makes the same calls as one in callbacks that does the
// same (tests/support/callback_carrier.cpp): with the same digests.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/program.hpp"

namespace fleetproof::straight_line_test {
namespace {

// The object of which each example and test agent has one, by its file name.
std::string object(const std::string& file_name) {
  std::string path = FLEETPROOF_EXAMPLE;
  return path.replace(path.rfind('/') + 1, std::string::npos, file_name);
}

using StraightLine = test::ProgramTest;

// The rows of an agent without what names the agent or the place of the row: run, cell, agent and scenario_digest.
std::vector<std::string> rows(const std::string& csv, const std::string& agent) {
  static const std::regex digests("(,[0-9a-f]{16}),[0-9a-f]{16},");
  std::vector<std::string> found;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    const auto name = line.find("," + agent + ",");
    if (name == std::string::npos) continue;
    const auto replicate = line.rfind(',', name - 1);
    const std::string row = line.substr(replicate, name - replicate) + line.substr(name + agent.size() + 1);
    found.push_back(std::regex_replace(row, digests, "$1,"));
  }
  return found;
}

TEST_F(StraightLine, HasTheDigestsOfItsTwinInCallbacks) {
  const std::string agents = "[\"" + object("carrier.so") + "\", \"" + object("callback_carrier.so") + "\"]";
  write("c.toml", R"(kind = "search"
seed = 6
replicates = 8
horizon_s = 200
[factors]
agents = )" + agents + R"(
layouts = ["aisle-grid"]
fleet_sizes = [5]
loss = [0.3]
delay_s = [1]
call_cost_s = [0, 0.003, 0.7]
[radio]
delay_model = "uniform"
duplicates = 0.05
[world]
transports_per_agv_hour = 60
[faults]
restarts_per_agv_hour = 20
freezes_per_agv_hour = 20
power_failures_per_agv_hour = 10
protective_stops_per_agv_hour = 10
)");
  ASSERT_EQ(run("run c.toml --db c.db").exit_code, 4) << "a search claims nothing";
  ASSERT_EQ(run("report c.db --evidence c.d").exit_code, 4);
  const std::string csv = read(path("c.d/runs.csv"));
  const auto straight = rows(csv, "carrier"), callbacks = rows(csv, "callback-carrier");
  EXPECT_EQ(straight.size(), 24U);
  EXPECT_EQ(straight, callbacks);
  EXPECT_EQ(std::set(straight.begin(), straight.end()).size(), 24U) << "every run is another one";
}

}  // namespace
}  // namespace fleetproof::straight_line_test
