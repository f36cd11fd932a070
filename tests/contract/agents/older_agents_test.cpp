// Agents that were built with the header of an older minor version.
#include <gtest/gtest.h>

#include <cstddef>

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

TEST(OlderAgents, DoWhatTheSameAgentDoesThatIsBuiltWithTodaysHeader) {
  AgentPrograms programs;
  const std::string today = programs.load(FLEETPROOF_AGENT_OF_TODAY);
  const Outcome expected = simulate(restless(), programs.find(today, ""), {});
  EXPECT_FALSE(expected.crash) << expected.message;
  EXPECT_GT(expected.counters.drives, 5U);
  EXPECT_GT(expected.counters.received, 100U);
  for (const char* path : {FLEETPROOF_AGENT_OF_MINOR_0, FLEETPROOF_AGENT_OF_MINOR_1}) {
    const fp_agent_type& older = programs.find(programs.load(path), "");
    EXPECT_LT(older.abi_minor, FP_ABI_MINOR);
    EXPECT_EQ(simulate(restless(), older, {}), expected) << path;
  }
}

}  // namespace
}  // namespace fleetproof::older_agents_test
