#pragma once

#include "campaign/batch/campaign.hpp"
#include "campaign/run/run_one.hpp"
#include "core/engine/simulation.hpp"
#include "tests/support/hard_world.hpp"

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
  plan.factors[Factor::Loss] = {0.0, 0.4};
  plan.factors[Factor::Delay] = {0.0, 2.0};
  plan.demand.transports_per_agv_hour = 60.0;
  GateRecord gate;
  gate.name = "small gate";
  gate.agent = "hull-lock";
  gate.limit = 0.9;
  plan.gates = {gate};
  return plan;
}

// The same with every fault switched on, and with bends.
inline CampaignPlan hostile_plan() {
  CampaignPlan plan = small_plan();
  plan.name = "hostile";
  plan.layouts = {{"loop-spurs", nullptr}, {"bent", bent_map(family_range("random-planar"), 5)}};
  plan.factors[Factor::MeanOutage] = {0.0, 1.0};
  plan.placement = Placement::Mixed;
  plan.radio.delay_model = RadioSetup::DelayModel::Uniform;
  plan.radio.duplicates = 0.05;
  VehicleType& type = plan.vehicles[0].type;
  type.loaded = {.extra_length_m = 0.1, .extra_width_m = 0.1, .speed_share = 0.8, .acceleration_share = 0.9};
  type.lateral_mps2 = 0.4;
  type.speed_deviation = 0.05;
  type.battery_per_m = 0.002;
  VehicleType slow = type;
  slow.name = "slow";
  slow.drive.speed_mps = 1.0;
  plan.vehicles.push_back({slow, 0.5});
  plan.faults = hard_world(plan.horizon_s).faults;
  plan.faults.load_drops_per_transport = 0.3;
  plan.faults.obstacles_per_hour = 60.0;
  plan.scanner.on = true;
  plan.operator_help.on = true;
  return plan;
}

}  // namespace fleetproof::test
