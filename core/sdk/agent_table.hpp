// What stands in an agent's table, which was shorter before some minor versions of agent.h. For whoever calls agents.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// Before minor 5, FP_SERVES_COMPUTERS meant nothing.
inline std::uint32_t flags_of(const fp_agent_type& type) {
  return type.abi_minor >= 5 ? type.flags : type.flags & ~FP_SERVES_COMPUTERS;
}
// Whether the program may run on computers.
inline bool serves_computers(const fp_agent_type& type) { return (flags_of(type) & FP_SERVES_COMPUTERS) != 0; }

// Null: the type has no data of its own. Before minor 6 the table ended earlier.
inline const fp_bridge* bridge_of(const fp_agent_type& type) {
  constexpr std::size_t kSize = offsetof(fp_agent_type, bridge) + sizeof(fp_agent_type::bridge);
  return type.abi_minor >= 6 && type.struct_size >= kSize ? type.bridge : nullptr;
}

// Creates an agent; null: it cannot start. Code of the program runs.
inline void* create_agent(const fp_agent_type& type, const fp_host* host, fp_controller* controller,
                          const fp_briefing* briefing) {
  const fp_bridge* bridge = bridge_of(type);
  if (bridge == nullptr || bridge->create_in == nullptr) return type.create(host, controller, briefing);
  return bridge->create_in(bridge->own, host, controller, briefing);
}

// Whether the program takes named faults with this word. Code of the program runs.
inline bool knows_fault(const fp_agent_type& type, const char* word) {
  const fp_bridge* bridge = bridge_of(type);
  if (bridge != nullptr && bridge->knows_fault_in != nullptr) return bridge->knows_fault_in(bridge->own, word) != 0;
  constexpr std::size_t kSize = offsetof(fp_agent_type, knows_fault) + sizeof(fp_agent_type::knows_fault);
  const bool is_there = type.abi_minor >= 5 && type.struct_size >= kSize;
  return is_there && type.knows_fault != nullptr && type.knows_fault(word) != 0;
}

}  // namespace fleetproof
