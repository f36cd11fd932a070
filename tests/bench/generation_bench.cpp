// Drawing a world against simulating it: 5 AGVs, 60 s, the sound agent under the exact law. Drawing is to cost less
// than a tenth.
#include <benchmark/benchmark.h>

#include <deque>

#include "campaign/run/agent_programs.hpp"
#include "core/engine/simulation.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"

namespace fleetproof {
namespace {

WorldSpec spec_of(const std::string& layout, Placement placement) {
  WorldSpec spec;
  spec.layout = layout;
  spec.placement = placement;
  spec.fleet_size = 5;
  spec.horizon = std::chrono::seconds(60);
  return spec;
}

constexpr std::uint64_t kWorlds = 64;

void generate(benchmark::State& state, const std::string& layout, Placement placement) {
  const auto spec = spec_of(layout, placement);
  RejectionCounts counts;
  std::uint64_t seed = 0;
  for (auto _ : state) benchmark::DoNotOptimize(generate_world(spec, seed++ % kWorlds, counts));
}

void simulate_worlds(benchmark::State& state, const std::string& layout) {
  const AgentPrograms programs;
  const fp_agent_type& agent = programs.find("hull-lock", "bench");
  RejectionCounts counts;
  std::deque<Scenario> worlds;
  for (std::uint64_t seed = 0; seed < kWorlds; ++seed) {
    worlds.push_back(generate_world(spec_of(layout, Placement::Random), seed, counts));
    worlds.back().radio.loss = 0.4;
    worlds.back().radio.delay_s = 2.0;
  }
  std::uint64_t n = 0;
  for (auto _ : state) {
    const Scenario& scenario = worlds[n++ % kWorlds];
    std::vector<std::unique_ptr<Law>> laws;
    laws.push_back(find_law("exact")->make(scenario));
    benchmark::DoNotOptimize(simulate(scenario, agent, laws));
  }
}

// The most expensive case: a one-way loop with bends, which few changes leave whole.
void generate_mutation(benchmark::State& state) {
  Draws draws(1);
  WorldSpec spec = spec_of("", Placement::Random);
  spec.layout = std::make_shared<const LogicalMap>(layout_family("loop-spurs").make(draws, Range::Normal));
  spec.mutate = true;
  RejectionCounts counts;
  std::uint64_t seed = 0;
  for (auto _ : state) benchmark::DoNotOptimize(generate_world(spec, seed++ % kWorlds, counts));
}
BENCHMARK(generate_mutation)->Unit(benchmark::kMicrosecond);

const bool registered = [] {
  for (const auto& family : layout_families()) {
    for (const Range range : {Range::Normal, Range::Stress}) {
      const auto layout = family_name(family.name, range);
      const auto add = [](const std::string& name, auto&& body) {
        benchmark::RegisterBenchmark(name.c_str(), body)->Unit(benchmark::kMicrosecond);
      };
      add("generate/" + layout, [layout](benchmark::State& state) { generate(state, layout, Placement::Random); });
      add("generate_adversarial/" + layout,
          [layout](benchmark::State& state) { generate(state, layout, Placement::Adversarial); });
      add("simulate/" + layout, [layout](benchmark::State& state) { simulate_worlds(state, layout); });
    }
  }
  return true;
}();

}  // namespace
}  // namespace fleetproof
