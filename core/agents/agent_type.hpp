#pragma once

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

using CreateFunction = void* (*)(const fp_host*, fp_controller*, const fp_briefing*);

// The C table for an agent class. `create` returns a new instance.
template <class Agent>
constexpr fp_agent_type agent_type(const char* name, const char* description, CreateFunction create) {
  return {sizeof(fp_agent_type),
          FP_ABI_MAJOR,
          FP_ABI_MINOR,
          FP_DETERMINISTIC,
          name,
          description,
          create,
          [](void* agent, const fp_event* event) { static_cast<Agent*>(agent)->on_event(*event); },
          [](void* agent) { delete static_cast<Agent*>(agent); }};
}

extern const fp_agent_type kHullLock;
extern const fp_agent_type kReckless;
extern const fp_agent_type kScripted;

}  // namespace fleetproof::agents
