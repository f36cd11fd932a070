#pragma once

#include <cstdint>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/engine/call_limits.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {
class AgvController;
class CallTape;
}  // namespace fleetproof

// The handle that an agent holds: which AGV of which run, and what the activation under way has used so far.
struct fp_controller {
  fleetproof::AgvController* part = nullptr;
  fleetproof::AgvId agv;
  bool hears_notes = false;               // as RunContext::hears_notes
  fleetproof::CallTape* tape = nullptr;   // takes the calls of the activation; null: nobody records them
  fleetproof::Duration cost{};            // of its calls
  std::uint64_t calls = 0, services = 0;  // so many
  std::uint64_t calls_max = 0;            // so many are admitted; none outside an activation

  bool in_activation() const { return calls_max > 0; }
  // Which limit the agent has exceeded, in words; null: none.
  const char* broken_limit() const {
    return calls > fleetproof::kCallsMax         ? "10 000 controller calls in one activation"
           : services > fleetproof::kServicesMax ? "ten million calls of random and now_ns in one activation"
                                                 : nullptr;
  }
};
