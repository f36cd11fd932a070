// Agents that were built with the header of an older minor version.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string_view>

#include "campaign/run/agent_programs.hpp"
#include "core/engine/simulation.hpp"
#include "tests/core/row_of_tens.hpp"

namespace fleetproof::older_agents_test {
namespace {

Scenario restless() {
  Scenario scenario = test::row_of_tens({0, 3}, 300.0);
  scenario.agvs[0].transports = {{StationId{0U}, StationId{1U}, seconds(2.0)},
                                 {StationId{1U}, StationId{0U}, seconds(3.0)}};
  scenario.agvs[1].transports = {{StationId{3U}, StationId{2U}, seconds(2.0)}};
  scenario.faults = {test::fault(Fault::Kind::Restart, 40.0, 5.0), test::fault(Fault::Kind::Breakdown, 80.0, 5.0)};
  scenario.radio.loss = 0.2;
  scenario.contact_stops = false;
  return scenario;
}

// The agent that is built with the header of a minor version; each is named after it.
std::string built_with(std::uint32_t minor) {
  std::string path = FLEETPROOF_AGENT_OF_MINOR_0;
  return path.replace(path.find("minor_0") + std::string_view("minor_").size(), 1, std::to_string(minor));
}

TEST(OlderAgents, DoWhatTheSameAgentDoesThatIsBuiltWithTodaysHeader) {
  AgentPrograms programs;
  const std::string today = programs.load(FLEETPROOF_AGENT_OF_TODAY);
  const Outcome expected = simulate(restless(), programs.find(today, ""), {});
  EXPECT_FALSE(expected.crash) << expected.message;
  EXPECT_GT(expected.counters.drives, 5U);
  EXPECT_GT(expected.counters.received, 100U);
  for (std::uint32_t minor = 0; minor < FP_ABI_MINOR; ++minor) {
    const std::string path = built_with(minor);
    const fp_agent_type& older = programs.find(programs.load(path), "");
    EXPECT_EQ(older.abi_minor, minor);
    EXPECT_EQ(simulate(restless(), older, {}), expected) << path;
  }
}

// Objects that were built once, with the header and the compiler of their time.
TEST(OlderAgents, DoTheSameAsObjectsThatNobodyCanBuildAgain) {
#if !defined(__x86_64__)
  GTEST_SKIP() << "the objects are for x86-64";
#endif
  Scenario scenario = restless();
  scenario.horizon = seconds(60.0);
  AgentPrograms today;
  const Outcome expected = simulate(scenario, today.find(today.load(FLEETPROOF_AGENT_OF_TODAY), ""), {});
  EXPECT_NE(expected.digest, 0U);
  AgentPrograms programs;
  for (std::uint32_t minor = 0; minor < FP_ABI_MINOR; ++minor) {
    const std::string path = fmt::format("{}/tests/support/objects/minor_{}.so", FLEETPROOF_SOURCE_DIR, minor);
    const fp_agent_type& older = programs.find(programs.load(path), "");
    EXPECT_EQ(older.abi_minor, minor);
    const Outcome found = simulate(scenario, older, {});
    EXPECT_EQ(found.digest, expected.digest) << path;
    EXPECT_EQ(found, expected) << path;
  }
}

}  // namespace
}  // namespace fleetproof::older_agents_test
