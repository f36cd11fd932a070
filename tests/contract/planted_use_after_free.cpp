// A use after free planted in a run, for the address sanitizer to find: the agent reads its first message after it has
// thrown it away.
#include <cstdio>
#include <memory>

#include "core/engine/simulation.hpp"
#include "tests/support/worlds.hpp"

namespace {

struct Agent {
  const fp_host* host;
  fp_controller* controller;
  std::unique_ptr<std::uint64_t> started_ns;
};

const fp_agent_type kForgetfulAgent = {sizeof(fp_agent_type),
                                       FP_ABI_MAJOR,
                                       FP_ABI_MINOR,
                                       0,
                                       "forgetful",
                                       "reads memory that it has given back",
                                       [](const fp_host* host, fp_controller* controller, const fp_briefing*) -> void* {
                                         return new Agent{host, controller, std::make_unique<std::uint64_t>(0)};
                                       },
                                       [](void* agent, const fp_event* event) {
                                         auto* self = static_cast<Agent*>(agent);
                                         const std::uint64_t* started_ns = self->started_ns.get();
                                         self->started_ns.reset();
                                         const auto delay_ns = 10'000'000 + static_cast<std::int64_t>(*started_ns);
                                         self->host->set_timer(self->controller, 1, event->now_ns + delay_ns);
                                       },
                                       [](void* agent) { delete static_cast<Agent*>(agent); },
                                       nullptr,
                                       nullptr};

}  // namespace

int main() {
  using namespace fleetproof;
  const Outcome outcome = simulate(test::row_scenario(3, {0, 2}), kForgetfulAgent, {});
  std::printf("%llu events\n", static_cast<unsigned long long>(outcome.counters.events));
  return 0;
}
