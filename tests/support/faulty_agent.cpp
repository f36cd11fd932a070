// An agent that drives like `hull-lock` but does not get its work done. Its parameters say how: "stop": after 100 s the
// whole fleet stands still. "starve": the first AGV never hears of its orders. "slow": every AGV thinks for a minute
// after each action. "misplace": loads are brought to another station than their order names. Otherwise it is sound.
#include <cstring>
#include <string>

#include "core/agents/agent_type.hpp"
#include "tests/support/reference_agent.hpp"

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

struct Faulty {
  const fp_agent_type* type = nullptr;
  void* inner = nullptr;
  const fp_host* host = nullptr;
  fp_controller* controller = nullptr;
  const fp_briefing* briefing = nullptr;
  std::string kind;
};

void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  auto* agent = new Faulty{
      &fleetproof::test::reference_agent("hull-lock"), nullptr, host, controller, briefing, briefing->config};
  fp_briefing own = *briefing;
  own.config = "";
  agent->inner = agent->type->create(host, controller, &own);
  return agent;
}

std::uint32_t another_storage_station(const Faulty& agent, const fp_event& order) {
  for (std::uint32_t station = 0; station < agent.briefing->map->station_count; ++station) {
    const bool stores = (agent.briefing->map->stations[station].purposes & FP_STORAGE) != 0;
    if (stores && station != order.from && station != order.to) return station;
  }
  return order.to;
}

void on_event(void* instance, const fp_event* event) {
  auto& agent = *static_cast<Faulty*>(instance);
  fp_event told = *event;
  const bool is_order = event->kind == FP_EVENT_ORDER;
  if (agent.kind == "stop" && event->now_ns > 100 * kSecond) return;
  if (agent.kind == "starve" && is_order && agent.briefing->self == 0) return;
  if (agent.kind == "slow" && event->kind == FP_EVENT_ACTION_DONE)
    agent.host->declare_cost_ns(agent.controller, 60 * kSecond);
  if (agent.kind == "misplace" && is_order) told.to = another_storage_station(agent, *event);
  agent.type->on_event(agent.inner, &told);
}

void destroy(void* instance) {
  auto* agent = static_cast<Faulty*>(instance);
  agent->type->destroy(agent->inner);
  delete agent;
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t) {
  static fp_agent_type type = {};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.name = "faulty";
  type.description = "drives like hull-lock and does not get its work done";
  type.create = create;
  type.on_event = on_event;
  type.destroy = destroy;
  return &type;
}
