// What the agents of a run share saves work and changes nothing.
#include <gtest/gtest.h>

#include <string>

#include "campaign/run/agent_programs.hpp"
#include "core/agents/agents.h"
#include "core/engine/fleet_software.hpp"
#include "core/engine/simulation.hpp"
#include "core/sdk/agent_table.hpp"
#include "laws/laws.hpp"
#include "tests/support/hard_world.hpp"

namespace fleetproof::shared_facts_test {
namespace {

Scenario hard_scenario(std::uint64_t seed, FamilyRange family) {
  WorldSpec spec = test::hard_world(60.0);
  spec.layout = test::bent_map(family, seed);
  spec.vehicles[1].type.footprint.length_m += 0.4;  // agents that err about sizes ask for other hulls
  spec.fleet_size = 4;
  RejectionCounts rejected;
  Scenario scenario = generate_world(spec, seed, rejected);
  scenario.radio.loss = 0.3;
  scenario.radio.delay_s = 0.5;
  return scenario;
}

// On board, with a zone-server if it is a follower; or on a computer, with followers.
Outcome outcome_of(Scenario scenario, const fp_agent_type& agent, bool share_facts) {
  RunWatch watch;
  watch.share_facts = share_facts;
  const AgentPrograms programs;
  const fp_agent_type &server = programs.find("zone-server", ""), &follower = programs.find("follower", "");
  const bool serves = serves_computers(agent), follows = &agent == &follower || fp_sound_agent(&agent) == &follower;
  FleetSoftware software({&agent, ""}, {});
  if (serves) software = FleetSoftware({&follower, ""}, {{&agent, ""}});
  if (follows) software = FleetSoftware({&agent, ""}, {{&server, ""}});
  if (serves || follows) scenario.computers.push_back({.name = "server"});
  const fp_agent_type &vehicle = programs.find("vda5050", ""), &broker = programs.find("mqtt-broker", ""),
                      &master = programs.find("vda5050-master", "");
  if (&agent == &vehicle || &agent == &broker || &agent == &master) {
    software = FleetSoftware({&vehicle, ""}, {{&broker, ""}, {&master, ""}});
    scenario.computers = {{.name = "broker"}, {.name = "master"}};
  }
  return simulate(scenario, software, make_default_laws(scenario), nullptr, watch);
}

TEST(SharedFacts, EveryAgentOfTheProgramDoesTheSameWithAndWithoutThem) {
  const AgentPrograms programs;
  std::uint64_t seed = 40;
  for (const auto& program : programs.all()) {
    ++seed;
    const char* family = seed % 2 == 0 ? "random-planar" : "dense-crossing/stress";
    const Scenario scenario = hard_scenario(seed, family_range(family));
    const Outcome shared = outcome_of(scenario, *program.opened.type, true);
    EXPECT_EQ(shared, outcome_of(scenario, *program.opened.type, false))
        << program.opened.type->name << " in world " << seed;
    EXPECT_FALSE(shared.crash) << shared.message;
  }
}

TEST(SharedFacts, TheSoundAgentDrivesAndAsksMuch) {
  const AgentPrograms programs;
  const Outcome outcome =
      outcome_of(hard_scenario(7, family_range("aisle-grid")), programs.find("hull-lock", ""), true);
  EXPECT_GT(outcome.counters.drives, 5U);
  EXPECT_GT(outcome.counters.received, 100U);
}

}  // namespace
}  // namespace fleetproof::shared_facts_test
