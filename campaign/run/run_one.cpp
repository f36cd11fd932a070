#include "campaign/run/run_one.hpp"

#include <utility>

#include "core/base/error.hpp"
#include "core/engine/simulation.hpp"
#include "core/scenario/canonical_bytes.hpp"
#include "laws/laws.hpp"

namespace fleetproof {

RunOne::RunOne(const CampaignPlan& plan, const AgentPrograms& programs)
    : plan_(plan), scenarios_(plan), programs_(programs), handles_(plan.agents.size()) {}

// An agent that calls too late is an agent of its own factor, whatever else its software runs as.
ForeignHandles* RunOne::handles_of(std::uint64_t cell) const {
  const AgentFactor& agent = plan_.agent_of_cell(cell);
  if (!programs_.needs_worker(agent)) return nullptr;
  const std::lock_guard lock(mutex_);
  auto& handles = handles_[agent_of_run(cell, plan_.agents.size())];
  if (handles == nullptr) handles = std::make_unique<ForeignHandles>(programs_.changed_processor(agent));
  return handles.get();
}

RunRecord RunOne::empty_record(std::uint64_t run_index) const {
  const RunPlace place = scenarios_.place(run_index);
  RunRecord record;
  record.run_index = run_index;
  record.cell = place.cell.index;
  record.replicate = place.replicate;
  record.factors = place.factors;
  return record;
}

RunRecord RunOne::operator()(std::uint64_t run_index, TraceSink* sink, const RunWatch& watch,
                             std::unique_ptr<Law> also) const {
  RunRecord record = empty_record(run_index);
  WorldCache::Loan world;
  try {
    world = worlds_.borrow(scenarios_.world_number(run_index), [&] {
      RejectionCounts ignored;
      return scenarios_.world(run_index, ignored);
    });
  } catch (const InputError& no_world) {
    // This seed found no room for the fleet. The run stays in the count, as one of which nothing is known.
    record.outcome.indeterminate = true;
    record.outcome.message = no_world.what();
    return record;
  }
  const Scenario scenario = scenarios_.in_world(world->scenario, run_index);
  const AgentFactor& factor = plan_.agent_of_cell(record.cell);
  const bool is_played = !watch.play.empty();
  auto laws = make_default_laws(scenario, plan_.laws_left_out);
  if (also) laws.push_back(std::move(also));
  record.scenario_digest = scenario_digest(scenario);
  RunWatch in_plant = watch;
  in_plant.plant = &world->plant;
  in_plant.foreign = is_played ? nullptr : handles_of(record.cell);
  record.outcome = simulate(
      scenario,
      is_played ? programs_.software_to_play(scenario) : programs_.software(factor, plan_.agent_config, scenario), laws,
      sink, in_plant);
  return record;
}

}  // namespace fleetproof
