// The programs that are built in here, beside those of core/agents.
#pragma once

#include <cstdint>
#include <span>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

struct BuiltInProgram {
  const fp_agent_type* type = nullptr;
  const fp_agent_type* sound = nullptr;  // of a program with a planted fault: what it is but for its fault
  std::uint32_t most_of_each = FP_NONE;  // with so many stations, drives and AGVs, each, it can start at most
};
std::span<const BuiltInProgram> bridge_programs();

}  // namespace fleetproof
