// A race planted in a run, for the thread sanitizer to find: the agent counts its events in a variable that all runs
// share.
#include <cstdio>

#include "campaign/batch/task_pool.hpp"
#include "core/engine/simulation.hpp"
#include "tests/support/worlds.hpp"

namespace {

std::uint64_t shared_events = 0;

struct Agent {
  const fp_host* host;
  fp_controller* controller;
};

const fp_agent_type kRacyAgent = {sizeof(fp_agent_type),
                                  FP_ABI_MAJOR,
                                  FP_ABI_MINOR,
                                  0,
                                  "racy",
                                  "keeps state outside its instance",
                                  [](const fp_host* host, fp_controller* controller, const fp_briefing*) -> void* {
                                    return new Agent{host, controller};
                                  },
                                  [](void* agent, const fp_event* event) {
                                    const auto* self = static_cast<Agent*>(agent);
                                    ++shared_events;
                                    self->host->set_timer(self->controller, 1, event->now_ns + 10'000'000);
                                  },
                                  [](void* agent) { delete static_cast<Agent*>(agent); },
                                  nullptr,
                                  nullptr};

}  // namespace

int main() {
  using namespace fleetproof;
  const Scenario scenario = test::row_scenario(3, {0, 2});
  TaskPool<Outcome> pool({.workers = 2, .end = 100}, [&](std::uint64_t) { return simulate(scenario, kRacyAgent, {}); });
  std::uint64_t runs = 0;
  pool.take_all([&](std::uint64_t, const Outcome&) { ++runs; });
  std::printf("%llu runs, %llu events counted\n", static_cast<unsigned long long>(runs),
              static_cast<unsigned long long>(shared_events));
  return 0;
}
