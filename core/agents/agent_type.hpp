#pragma once

#include <cstdint>

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
          [](void* agent) { delete static_cast<Agent*>(agent); },
          nullptr,
          nullptr};
}

// An agent behind one interface: its class stays in its source.
class Program {
 public:
  Program() = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  virtual ~Program() = default;
  virtual void on_event(const fp_event& event) = 0;
};

// The most stations, lanes or AGVs that a plant may have for agents whose paths and messages name each by 16 bits.
inline constexpr std::uint32_t kNumbersOnTheWire = 0xffff;
// Whether this plant has no more of them. If it has, it says why the agent cannot start.
bool has_numbers_for_all(const fp_host& host, fp_controller* controller, const fp_briefing& briefing);
// For `create`: the sentence goes to hosts that hear it (minor 4). Returns false.
bool cannot_start(const fp_host& host, fp_controller* controller, const char* why);
// Whether an agent that is on board alone gets transports of its own. If all are open, each AGV would go to every load:
// then it says why it cannot start.
bool gets_own_transports(const fp_host& host, fp_controller* controller, const fp_briefing& briefing);

extern const fp_agent_type kHullLock;
extern const fp_agent_type kReckless;
extern const fp_agent_type kScripted;

}  // namespace fleetproof::agents
