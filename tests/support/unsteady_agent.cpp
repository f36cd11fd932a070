// An agent that drives like `reckless` but does not always do the same. Its parameters say why: "addresses": it looks
// at its neighbours in the order of their addresses. "static": a counter that all AGVs of the process share. "memory":
// it reads memory that it never wrote. Otherwise it always does the same.
#include <cstdint>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/agents/agent_type.hpp"
#include "core/agents/agents.h"

namespace {

struct Neighbour {
  std::uint32_t agv = 0;
};

int shared_by_all = 0;

struct Unsteady {
  const fp_agent_type* type = nullptr;
  void* inner = nullptr;
  const fp_host* host = nullptr;
  fp_controller* controller = nullptr;
  std::string kind;
  std::vector<std::unique_ptr<Neighbour>> owned;
  std::set<Neighbour*> neighbours;
};

std::uint32_t read_unwritten() {
  const std::unique_ptr<std::uint32_t[]> fresh(new std::uint32_t[8]);
  volatile const std::uint32_t* words = fresh.get();
  return words[5];
}

// What the thinking of this AGV costs: it changes when its calls take effect.
std::int64_t cost_ms(const Unsteady& agent) {
  if (agent.kind == "addresses") return 1 + (*agent.neighbours.begin())->agv;
  if (agent.kind == "static") return ++shared_by_all % 7;
  if (agent.kind == "memory") return read_unwritten() % 7;
  return 1;
}

void* create(const fp_host* host, fp_controller* controller, const fp_briefing* briefing) {
  auto* agent = new Unsteady;
  for (std::uint32_t i = 0; i < fp_reference_agent_count; ++i) {
    if (std::strcmp(fp_reference_agents[i]->name, "reckless") == 0) agent->type = fp_reference_agents[i];
  }
  agent->inner = agent->type->create(host, controller, briefing);
  agent->host = host;
  agent->controller = controller;
  agent->kind = briefing->config;
  for (std::uint32_t agv = 0; agv < briefing->fleet_count; ++agv) {
    agent->owned.push_back(std::make_unique<Neighbour>(Neighbour{agv}));
    agent->neighbours.insert(agent->owned.back().get());
  }
  return agent;
}

void on_event(void* instance, const fp_event* event) {
  auto& agent = *static_cast<Unsteady*>(instance);
  agent.host->declare_cost_ns(agent.controller, cost_ms(agent) * 1'000'000);
  agent.type->on_event(agent.inner, event);
}

void destroy(void* instance) {
  auto* agent = static_cast<Unsteady*>(instance);
  agent->type->destroy(agent->inner);
  delete agent;
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const fp_agent_type* fp_agent_query(uint32_t) {
  static fp_agent_type type = {};
  type.struct_size = sizeof type;
  type.abi_major = FP_ABI_MAJOR;
  type.name = "unsteady";
  type.description = "drives like reckless and does not always do the same";
  type.create = create;
  type.on_event = on_event;
  type.destroy = destroy;
  return &type;
}
