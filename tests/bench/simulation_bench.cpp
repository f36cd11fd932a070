// Whole runs: how many a second, and what each costs in counts that no machine changes.
#include <benchmark/benchmark.h>

#include "campaign/run/agent_programs.hpp"
#include "core/engine/simulation.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"
#include "tests/bench/allocations.hpp"
#include "tests/support/grid_world.hpp"

namespace fleetproof {
namespace {

struct World {
  int rows, columns;
  std::uint32_t fleet;
  double horizon_s;
};
constexpr World kSmall{4, 8, 5, 60.0};      // 56 segments
constexpr World kLarge{12, 24, 50, 600.0};  // 552 segments

enum class Watch { Nobody, Judge, DefaultSet };

std::vector<std::unique_ptr<Law>> observers(Watch watch, const Scenario& scenario) {
  if (watch == Watch::DefaultSet) return make_default_laws(scenario);
  std::vector<std::unique_ptr<Law>> laws;
  if (watch == Watch::Judge) laws.push_back(find_law("safety-distance")->make(scenario));
  return laws;
}

void run(benchmark::State& state, const World& world, const char* agent_name, Watch watch) {
  const AgentPrograms programs;
  const fp_agent_type& agent = programs.find(agent_name, "bench");
  Scenario scenario = test::grid_world(world.rows, world.columns, world.fleet, world.horizon_s, 1);
  scenario.radio.loss = 0.4;
  scenario.radio.delay_s = 2.0;
  Counters sum;
  std::uint64_t runs = 0;
  const std::uint64_t allocated_before = allocations();
  for (auto _ : state) {
    scenario.seed = ++runs;
    const auto laws = observers(watch, scenario);
    const Outcome outcome = simulate(scenario, agent, laws);
    sum.events += outcome.counters.events;
    sum.messages_sent += outcome.counters.messages_sent;
    sum.receptions += outcome.counters.receptions;
    sum.distance_evaluations += outcome.counters.distance_evaluations;
    sum.drives += outcome.counters.drives;
    sum.transports_done += outcome.counters.transports_done;
  }
  const auto per_run = [&](std::uint64_t count) { return static_cast<double>(count) / static_cast<double>(runs); };
  state.counters["events"] = per_run(sum.events);
  state.counters["sent"] = per_run(sum.messages_sent);
  state.counters["receptions"] = per_run(sum.receptions);
  state.counters["evaluations"] = per_run(sum.distance_evaluations);
  state.counters["drives"] = per_run(sum.drives);
  state.counters["transports"] = per_run(sum.transports_done);
  state.counters["allocations"] = per_run(allocations() - allocated_before);
  state.counters["runs/s"] = benchmark::Counter(static_cast<double>(runs), benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(run, 5x60_hull_lock, kSmall, "hull-lock", Watch::Judge)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, 5x60_hull_lock_no_law, kSmall, "hull-lock", Watch::Nobody)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, 5x60_hull_lock_all_laws, kSmall, "hull-lock", Watch::DefaultSet)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, 5x60_reckless, kSmall, "reckless", Watch::Judge)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, 50x600_hull_lock, kLarge, "hull-lock", Watch::Judge)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, 50x600_hull_lock_no_law, kLarge, "hull-lock", Watch::Nobody)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, 50x600_hull_lock_all_laws, kLarge, "hull-lock", Watch::DefaultSet)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, 50x600_reckless, kLarge, "reckless", Watch::Judge)->Unit(benchmark::kMillisecond);

// A plant of 5000 stations with 100 AGVs: drawn, checked, and simulated for 300 s under all laws.
void plant(benchmark::State& state) {
  const AgentPrograms programs;
  WorldSpec spec;
  spec.layout = std::string("plant/5000");
  spec.fleet_size = 100;
  spec.horizon = std::chrono::seconds(300);
  std::uint64_t seed = 0;
  for (auto _ : state) {
    RejectionCounts counts;
    const Scenario scenario = generate_world(spec, ++seed, counts);
    const auto laws = make_default_laws(scenario);
    benchmark::DoNotOptimize(simulate(scenario, programs.find("reckless", "bench"), laws));
  }
}

BENCHMARK(plant)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fleetproof
