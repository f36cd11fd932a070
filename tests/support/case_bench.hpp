#pragma once

#include <string>

#include "campaign/shrink/case_host.hpp"
#include "campaign/shrink/failure_pattern.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof::test {

// A warehouse at the contract's worst radio.
inline Scenario bad_radio(std::uint64_t seed, std::uint32_t fleet_size = 5) {
  WorldSpec spec;
  spec.fleet_size = fleet_size;
  spec.horizon = std::chrono::seconds(60);
  spec.demand.transports_per_agv_hour = 60.0;
  RejectionCounts ignored;
  Scenario scenario = generate_world(spec, seed, ignored);
  scenario.radio.loss = 0.4;
  scenario.radio.delay_s = 2.0;
  scenario.radio.delay_model = RadioSetup::DelayModel::Uniform;
  return scenario;
}

// With copies of messages and restarts, too.
inline Scenario bad_night(std::uint64_t seed) {
  Scenario scenario = bad_radio(seed);
  scenario.radio.duplicates = 0.1;
  for (std::uint32_t agv = 0; agv < 5; ++agv)
    scenario.faults.push_back({.kind = Fault::Kind::Restart,
                               .agv = AgvId{agv},
                               .at = seconds(7.0 * agv),
                               .transport = {},
                               .lasts = seconds(0.5)});
  return scenario;
}

// An agent and its cases.
struct CaseBench {
  explicit CaseBench(const std::string& name, int workers = 2) : agent(name), host({name, ""}, programs, workers) {}
  // The first from this seed on that fails.
  Scenario failing(std::uint64_t seed) {
    for (;; ++seed) {
      Scenario scenario = bad_night(seed);
      if (failure_of(host(scenario))) return scenario;
    }
  }

  // The same without copies and restarts.
  FailingCase failing_by_radio(std::uint64_t seed) {
    for (;; ++seed) {
      const Scenario scenario = bad_radio(seed);
      if (const auto failure = failure_of(host(scenario))) return {scenario, *failure};
    }
  }

  std::string agent;
  AgentPrograms programs;
  CaseHost host;
};

}  // namespace fleetproof::test
