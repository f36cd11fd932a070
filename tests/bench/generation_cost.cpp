// What drawing a world costs against simulating it, in instructions: a count that no other job on the machine disturbs.
//
//   generation_cost LAYOUT WORLDS    for valgrind --tool=callgrind, which counts what each function below costs with
//   all it calls
//
// tests/bench/generation_table runs it over all layouts and prints the table. Worlds are those of the benchmark
// (generation_bench.cpp): 5 AGVs, 60 s, the sound agent under the exact law. LAYOUT is a family, normal or under
// stress, or `mutated-import`: mutations of a loop with spurs, the most expensive.
#include <fmt/format.h>

#include <cstdlib>
#include <deque>
#include <string>

#include "campaign/run/agent_programs.hpp"
#include "core/engine/simulation.hpp"
#include "generators/families/layout_family.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"

namespace fleetproof {
namespace {

WorldSpec spec_of(const std::string& layout) {
  WorldSpec spec;
  spec.fleet_size = 5;
  spec.horizon = std::chrono::seconds(60);
  if (layout == "mutated-import") {
    Draws draws(1);
    spec.layout = std::make_shared<const LogicalMap>(layout_family("loop-spurs").make(draws, Range::Normal));
    spec.mutate = true;
  } else {
    spec.layout = layout;
  }
  return spec;
}

std::deque<Scenario> draw_worlds(WorldSpec spec, Placement placement, std::uint64_t worlds) {
  spec.placement = placement;
  RejectionCounts counts;
  std::deque<Scenario> drawn;
  for (std::uint64_t seed = 0; seed < worlds; ++seed) drawn.push_back(generate_world(spec, seed, counts));
  return drawn;
}

}  // namespace

// One function for each figure, known to valgrind by its name.
extern "C" {
__attribute__((noinline)) std::deque<Scenario>* cost_of_random(const WorldSpec& spec, std::uint64_t worlds) {
  return new std::deque<Scenario>(draw_worlds(spec, Placement::Random, worlds));
}
__attribute__((noinline)) std::deque<Scenario>* cost_of_charger_bank(const WorldSpec& spec, std::uint64_t worlds) {
  return new std::deque<Scenario>(draw_worlds(spec, Placement::ChargerBank, worlds));
}
__attribute__((noinline)) std::deque<Scenario>* cost_of_adversarial(const WorldSpec& spec, std::uint64_t worlds) {
  return new std::deque<Scenario>(draw_worlds(spec, Placement::Adversarial, worlds));
}
__attribute__((noinline)) std::deque<Scenario>* cost_of_symmetric(const WorldSpec& spec, std::uint64_t worlds) {
  return new std::deque<Scenario>(draw_worlds(spec, Placement::Symmetric, worlds));
}
__attribute__((noinline)) std::uint64_t cost_of_simulation(const std::deque<Scenario>& worlds,
                                                           const fp_agent_type& agent) {
  std::uint64_t events = 0;
  for (const Scenario& scenario : worlds) {
    std::vector<std::unique_ptr<Law>> laws;
    laws.push_back(find_law("exact")->make(scenario));
    events += simulate(scenario, agent, laws).counters.events;
  }
  return events;
}
}

}  // namespace fleetproof

int main(int argc, char** argv) {
  using namespace fleetproof;
  if (argc != 3) return fmt::print("generation_cost LAYOUT WORLDS\n"), 2;
  const WorldSpec spec = spec_of(argv[1]);
  const auto worlds = static_cast<std::uint64_t>(std::atoll(argv[2]));
  delete cost_of_charger_bank(spec, worlds);
  delete cost_of_adversarial(spec, worlds);
  delete cost_of_symmetric(spec, worlds);
  const std::unique_ptr<std::deque<Scenario>> random(cost_of_random(spec, worlds));
  for (Scenario& scenario : *random) {
    scenario.radio.loss = 0.4;
    scenario.radio.delay_s = 2.0;
  }
  const AgentPrograms programs;
  fmt::print("{} worlds of {}, {} events\n", worlds, argv[1],
             cost_of_simulation(*random, programs.find("hull-lock", "bench")));
  return 0;
}
