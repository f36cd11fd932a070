#pragma once

#include "campaign/campaign.hpp"
#include "campaign/run_one.hpp"
#include "core/simulation.hpp"

namespace fleetproof::test {

// Small enough to run many times, hostile enough that every kind of agent meets trouble.
inline CampaignPlan small_plan() {
  CampaignPlan plan;
  plan.name = "small";
  plan.seed = 77;
  plan.replicates = 3;
  plan.horizon_s = 120.0;
  plan.agents = {"hull-lock", "timeout-grant", "reckless"};
  plan.layouts = {{"aisle-grid", nullptr}, {"corridor-sidings", nullptr}};
  plan.fleet_sizes = {4};
  plan.loss = {0.0, 0.4};
  plan.delay_s = {0.0, 2.0};
  plan.transports_per_agv_hour = 60.0;
  GateRecord gate;
  gate.name = "small gate";
  gate.agent = "hull-lock";
  gate.limit = 0.9;
  plan.gates = {gate};
  return plan;
}

}  // namespace fleetproof::test
