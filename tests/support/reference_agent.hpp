#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "core/agents/agents.h"

namespace fleetproof::test {

// Throws if there is no reference agent of this name.
inline const fp_agent_type& reference_agent(std::string_view name) {
  for (std::uint32_t i = 0; const fp_agent_type* agent = fp_reference_agent(i); ++i) {
    if (name == agent->name) return *agent;
  }
  throw std::invalid_argument("no reference agent is called " + std::string(name));
}

}  // namespace fleetproof::test
