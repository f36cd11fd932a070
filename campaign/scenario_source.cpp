#include "campaign/scenario_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/random.hpp"
#include "generators/world.hpp"

namespace fleetproof {

ScenarioSource::ScenarioSource(const CampaignPlan& plan) : plan_(plan), cells_(plan.cells()) {}

RunPlace ScenarioSource::place(std::uint64_t run_index) const { return {run_index / cells_.size(), cells_[run_index % cells_.size()]}; }

Scenario ScenarioSource::scenario(std::uint64_t run_index) const {
  RejectionCounts ignored;
  return scenario(run_index, ignored);
}

Scenario ScenarioSource::scenario(std::uint64_t run_index, RejectionCounts& rejected) const {
  const auto [replicate, cell] = place(run_index);
  const LayoutFactor& layout = *std::ranges::find(plan_.layouts, cell.layout, &LayoutFactor::name);
  WorldSpec spec;
  if (layout.map != nullptr) {
    spec.layout = layout.map;
  } else {
    spec.layout = layout.name;
  }
  spec.mutate = layout.mutate;
  spec.placement = plan_.placement;
  spec.hot_spot_skew = plan_.hot_spot_skew;
  spec.orders = plan_.orders;
  spec.fleet_size = cell.fleet_size;
  spec.transports_per_agv_hour = plan_.transports_per_agv_hour;
  spec.vehicles = plan_.vehicles;
  spec.faults = plan_.faults;
  spec.law = plan_.law;
  spec.horizon = seconds(plan_.horizon_s);
  const std::uint64_t factors = name_hash(fmt::format("{}/{}", cell.layout, cell.fleet_size));
  Scenario scenario = generate_world(spec, world_seed(plan_.seed, replicate, factors), rejected);
  scenario.name = fmt::format("{} run {}", plan_.name, run_index);
  scenario.radio = plan_.radio;
  scenario.radio.loss = cell.loss;
  scenario.radio.delay_s = cell.delay_s;
  scenario.radio.outages.mean_outage_s = cell.mean_outage_s;
  scenario.agent_clock = plan_.agent_clock;
  scenario.scanner = plan_.scanner;
  scenario.operator_help = plan_.operator_help;
  scenario.contact_stops = plan_.contact_stops;
  scenario.stuck_after = seconds(plan_.stuck_after_s);
  return scenario;
}

}  // namespace fleetproof
