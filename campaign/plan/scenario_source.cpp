#include "campaign/plan/scenario_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "campaign/plan/factor_fields.hpp"
#include "core/base/outside_text.hpp"
#include "core/base/random.hpp"
#include "generators/worlds/drawn_faults.hpp"
#include "generators/worlds/drawn_radio.hpp"
#include "generators/worlds/world_maker.hpp"

namespace fleetproof {

namespace {

double between(double from, double to, double unit) {
  return from == to ? from : std::min(to, from + (to - from) * unit);
}

}  // namespace

ScenarioSource::ScenarioSource(const CampaignPlan& plan)
    : plan_(plan), cells_(plan.cells()), sample_(plan.sampling, plan.seed, plan.replicates) {}

RunPlace ScenarioSource::place(std::uint64_t run_index) const {
  RunPlace place{run_index / cells_.size(), cells_[run_index % cells_.size()], {}};
  const CellRecord& cell = place.cell;
  place.factors = cell.lowest;
  if (!cell.is_drawn()) return place;
  // Each factor has its own dimension, whether it is drawn or not. If one more factor is drawn, the draws of the others
  // therefore stay the same.
  for (std::uint32_t dimension = 0; dimension < kFactors.size(); ++dimension) {
    const Factor factor = kFactors[dimension].id;
    place.factors[factor] = between(cell.lowest[factor], cell.highest[factor], sample_.at(place.replicate, dimension));
  }
  return place;
}

Scenario ScenarioSource::scenario(std::uint64_t run_index) const {
  RejectionCounts ignored;
  return scenario(run_index, ignored);
}

Scenario ScenarioSource::scenario(std::uint64_t run_index, RejectionCounts& rejected) const {
  return in_world(world(run_index, rejected), run_index);
}

Scenario ScenarioSource::world(std::uint64_t run_index, RejectionCounts& rejected) const {
  const std::uint64_t replicate = run_index / cells_.size();
  const CellRecord& cell = cells_[run_index % cells_.size()];
  const LayoutFactor& layout = *std::ranges::find(plan_.layouts, cell.layout, &LayoutFactor::name);
  WorldSpec spec;
  if (layout.map != nullptr) {
    spec.layout = layout.map;
  } else {
    spec.layout = layout.name;
  }
  spec.mutate = layout.mutate;
  spec.placement = plan_.placement;
  spec.orders = plan_.orders;
  spec.fleet_size = cell.fleet_size;
  spec.demand = plan_.demand;
  spec.order_setup = plan_.order_setup;
  spec.vehicles = plan_.vehicles;
  spec.faults = plan_.faults;
  spec.law = plan_.law;
  spec.horizon = seconds(plan_.horizon_s);
  const std::uint64_t factors = name_hash(fmt::format("{}/{}", cell.layout, cell.fleet_size));
  spec.held = {plan_.held_streams, world_seed(plan_.seed, plan_.held_replicate, factors)};
  return generate_world(spec, world_seed(plan_.seed, replicate, factors), rejected);
}

// Those for which the agent has programs. Each draws under its place in the plan, whatever other agents need.
void ScenarioSource::add_computers(Scenario& scenario, const AgentFactor& agent) const {
  if (agent.computers.empty()) return;
  scenario.wire = plan_.wire;
  for (std::uint32_t i = 0; i < plan_.computers.size(); ++i) {
    const auto& [setup, faults] = plan_.computers[i];
    if (agent.part_on(setup.name) == nullptr) continue;
    const EntityId id{scenario.participant_count()};
    ComputerSetup& computer = scenario.computers.emplace_back(setup);
    if (i + 1 != scenario.computers.size()) computer.draws_as = i;
    draw_computer_faults(scenario, id, faults, stream_key(scenario.seed_of(Stream::Faults), Stream::Faults));
  }
}

Scenario ScenarioSource::in_world(const Scenario& world, std::uint64_t run_index) const {
  Scenario scenario = world;
  // without characters that a scenario file refuses
  scenario.name = fmt::format("{} run {}", printable(plan_.name), run_index);
  scenario.radio = plan_.radio;
  scenario.radio.sources = draw_radio_sources(plan_.sources, scenario.map->layout(), scenario.seed_of(Stream::Radio));
  if (draws_constant_delay(plan_.constant_delay_share, scenario.seed_of(Stream::Radio)))
    scenario.radio.delay_model = RadioSetup::DelayModel::Constant;
  add_computers(scenario, plan_.agent_of_cell(run_index));
  scenario.agent_clock = plan_.agent_clock;
  scenario.scanner = plan_.scanner;
  scenario.operator_help = plan_.operator_help;
  set_factors(scenario, place(run_index).factors);
  scenario.contact_stops = plan_.contact_stops;
  scenario.stuck_after = seconds(plan_.stuck_after_s);
  return scenario;
}

}  // namespace fleetproof
