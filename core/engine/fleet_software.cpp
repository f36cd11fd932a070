#include "core/engine/fleet_software.hpp"

#include <cstddef>

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof {

// Before minor 5 the flag meant nothing.
bool serves_computers(const fp_agent_type& type) {
  return type.abi_minor >= 5 && (type.flags & FP_SERVES_COMPUTERS) != 0;
}

// Before minor 6 the table ended earlier.
const fp_bridge* bridge_of(const fp_agent_type& type) {
  constexpr std::size_t kSize = offsetof(fp_agent_type, bridge) + sizeof(fp_agent_type::bridge);
  return type.abi_minor >= 6 && type.struct_size >= kSize ? type.bridge : nullptr;
}

bool knows_fault(const fp_agent_type& type, const char* word) {
  const fp_bridge* bridge = bridge_of(type);
  if (bridge != nullptr && bridge->knows_fault_in != nullptr) return bridge->knows_fault_in(bridge->own, word) != 0;
  constexpr std::size_t kSize = offsetof(fp_agent_type, knows_fault) + sizeof(fp_agent_type::knows_fault);
  const bool is_there = type.abi_minor >= 5 && type.struct_size >= kSize;
  return is_there && type.knows_fault != nullptr && type.knows_fault(word) != 0;
}

std::string why_not_on_computer(std::string_view program, std::string_view computer) {
  return in_quotes(program) + " does not serve computers, so it cannot be the program of " + in_quotes(computer) +
         "; choose another, or set FP_SERVES_COMPUTERS in its fp_agent_type";
}

void check_roles(const Scenario& scenario, const FleetSoftware& software) {
  if (software.computers.size() != scenario.computers.size()) {
    throw InputError("computers", "the scenario has " + std::to_string(scenario.computers.size()) + ", and there are " +
                                      std::to_string(software.computers.size()) +
                                      " programs for them; give each computer one");
  }
  for (std::size_t i = 0; i < scenario.computers.size(); ++i) {
    const fp_agent_type& type = *software.computers[i].type;
    if (!serves_computers(type))
      throw InputError("computers", why_not_on_computer(type.name, scenario.computers[i].name));
  }
}

}  // namespace fleetproof
