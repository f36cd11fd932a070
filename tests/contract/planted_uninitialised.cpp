// A use of an uninitialised value planted in a run, for valgrind to find: no sanitizer of this project does. The agent
// decides by a member that nobody has set.
#include <cstdio>

#include "core/engine/simulation.hpp"
#include "tests/support/worlds.hpp"

namespace {

struct Agent {
  const fp_host* host;
  fp_controller* controller;
  std::int64_t delay_ns;

  Agent(const fp_host* its_host, fp_controller* its_controller) : host(its_host), controller(its_controller) {}
};

const fp_agent_type kUndecidedAgent = {sizeof(fp_agent_type),
                                       FP_ABI_MAJOR,
                                       FP_ABI_MINOR,
                                       0,
                                       "undecided",
                                       "reads memory that nobody has written",
                                       [](const fp_host* host, fp_controller* controller, const fp_briefing*) -> void* {
                                         return new Agent(host, controller);
                                       },
                                       [](void* agent, const fp_event* event) {
                                         auto* self = static_cast<Agent*>(agent);
                                         if (self->delay_ns > 1'000'000'000) return;
                                         self->host->set_timer(self->controller, 1, event->now_ns + 1'000'000'000);
                                       },
                                       [](void* agent) { delete static_cast<Agent*>(agent); },
                                       nullptr,
                                       nullptr};

}  // namespace

int main() {
  using namespace fleetproof;
  const Outcome outcome = simulate(test::row_scenario(3, {0, 2}), kUndecidedAgent, {});
  std::printf("%llu events\n", static_cast<unsigned long long>(outcome.counters.events));
  return 0;
}
