// What runs cost at one size of fleet, in counts that no other job on the machine disturbs, and in time.
//
//   run_cost AGENT FLEET HORIZON_S WORLDS [RANGE_M [KIND]] [none]
//
// AGENT: hull-lock, reckless, null, which only sends and listens, or rover, the example of README.md, which drives at
// random. rover/through: AGVs do not stop when they touch. Worlds have one AGV per 15 stations, 40 % loss and 2 s
// delay. Five AGVs also get the families of small layouts. RANGE_M is the radio's, 0 means that it has no bound. KIND:
// only floors of this kind, such as `plant`. `none`: no law watches. tests/bench/cost_table counts instructions of the
// functions `cost_of_...`.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "core/agents/agents.h"
#include "core/engine/simulation.hpp"
#include "generators/worlds/world_maker.hpp"
#include "laws/laws.hpp"
#include "tests/bench/allocations.hpp"
#include "tests/bench/null_agent.hpp"

extern "C" const fp_agent_type* fp_agent_query(uint32_t host_abi_major);  // of tests/examples/rover.cpp

namespace fleetproof {
namespace {

constexpr std::uint32_t kStationsPerAgv = 15;
constexpr std::string_view kThrough = "/through";

// `only`: a kind of floor; empty: all.
std::vector<std::string> layouts(std::uint32_t fleet, std::string_view only) {
  std::vector<std::string> names;
  for (const char* kind : {"plant", "plant/tight-gap", "plant/four-way", "plant/overhang-pass", "plant/bottleneck"}) {
    if (only.empty() || only == kind)
      names.push_back(fmt::format("{}/{}", kind, std::max(20U, kStationsPerAgv * fleet)));
  }
  if (fleet > 5 || !only.empty()) return names;
  for (const char* family :
       {"aisle-grid", "corridor-sidings", "loop-spurs", "random-planar", "fishbone", "dense-crossing"}) {
    for (const char* range : {"", "/stress"}) names.push_back(fmt::format("{}{}", family, range));
  }
  return names;
}

std::deque<Scenario> draw_worlds(const std::vector<std::string>& names, std::uint32_t fleet, double horizon_s,
                                 std::uint64_t worlds, double range_m) {
  std::deque<Scenario> drawn;
  RejectionCounts counts;
  for (std::uint64_t seed = 0; seed < worlds; ++seed) {
    WorldSpec spec;
    spec.layout = names[seed % names.size()];
    spec.fleet_size = fleet;
    spec.horizon = seconds(horizon_s);
    drawn.push_back(generate_world(spec, seed, counts));
    drawn.back().radio.loss = 0.4;
    drawn.back().radio.delay_s = 2.0;
    if (range_m > 0.0) drawn.back().radio.range_m = range_m;
  }
  return drawn;
}

// Null if there is none of this name.
const fp_agent_type* agent_named(std::string_view name) {
  if (name == kNullAgent.name) return &kNullAgent;
  if (const fp_agent_type* rover = fp_agent_query(FP_ABI_MAJOR); name == rover->name) return rover;
  for (std::uint32_t i = 0; const fp_agent_type* agent = fp_reference_agent(i); ++i) {
    if (name == agent->name) return agent;
  }
  return nullptr;
}

double seconds_of_this_thread() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

extern "C" __attribute__((noinline)) Counters cost_of_runs(const std::deque<Scenario>& worlds,
                                                           const fp_agent_type& agent, bool watched) {
  Counters sum;
  for (const Scenario& scenario : worlds) {
    std::vector<std::unique_ptr<Law>> laws;
    if (watched) laws = make_default_laws(scenario);
    const Outcome outcome = simulate(scenario, agent, laws);
    for (const CounterInfo& counter : kCounters) sum.*counter.member += outcome.counters.*counter.member;
  }
  return sum;
}

}  // namespace fleetproof

int main(int argc, char** argv) {
  using namespace fleetproof;
  if (argc < 5) return fmt::print("run_cost AGENT FLEET HORIZON_S WORLDS [RANGE_M [KIND]] [none]\n"), 2;
  const std::string_view said_agent = argv[1];
  const bool through = said_agent.ends_with(kThrough);
  const fp_agent_type* const agent =
      agent_named(said_agent.substr(0, said_agent.size() - (through ? kThrough.size() : 0)));
  if (agent == nullptr) return fmt::print("there is no agent {}\n", argv[1]), 2;
  const auto fleet = static_cast<std::uint32_t>(std::atoi(argv[2]));
  const double horizon_s = std::atof(argv[3]);
  const bool watched = std::string_view(argv[argc - 1]) != "none";
  const int said = watched ? argc : argc - 1;
  const auto names = layouts(fleet, said > 6 ? argv[6] : "");
  if (names.empty()) return fmt::print("there is no kind of floor {}\n", argv[6]), 2;
  auto worlds = draw_worlds(names, fleet, horizon_s, static_cast<std::uint64_t>(std::atoll(argv[4])),
                            said > 5 ? std::atof(argv[5]) : 0.0);
  for (Scenario& world : worlds) world.contact_stops = !through;
  const std::uint64_t allocated_before = allocations();
  const double begun_s = seconds_of_this_thread();
  const Counters sum = cost_of_runs(worlds, *agent, watched);
  const double spent_s = seconds_of_this_thread() - begun_s;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double agv_s = fleet * horizon_s * static_cast<double>(worlds.size());
  const double hours = agv_s / 3600.0;
  fmt::print(
      "agv_s {:.0f} events {} sent {} receptions {} drives {} transports {} evaluations {} "
      "contacts {}\n",
      agv_s, sum.events, sum.messages_sent, sum.receptions, sum.drives, sum.transports_done, sum.distance_evaluations,
      sum.contacts);
  fmt::print(
      "per AGV-second: events {:.2f} sent {:.3f}; transports per AGV-hour {:.2f}; allocations per event {:.3f}; "
      "runs/s {:.1f}; AGV-hours per core-hour {:.0f}; peak {} MB\n",
      static_cast<double>(sum.events) / agv_s, static_cast<double>(sum.messages_sent) / agv_s,
      static_cast<double>(sum.transports_done) / hours,
      static_cast<double>(allocations() - allocated_before) / static_cast<double>(sum.events),
      static_cast<double>(worlds.size()) / spent_s, agv_s / spent_s, usage.ru_maxrss / 1024);
  return 0;
}
