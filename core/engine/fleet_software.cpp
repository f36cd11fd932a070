#include "core/engine/fleet_software.hpp"

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"

namespace fleetproof {

// Before minor 5 the flag meant nothing.
bool serves_computers(const fp_agent_type& type) {
  return type.abi_minor >= 5 && (type.flags & FP_SERVES_COMPUTERS) != 0;
}

// Before minor 5 the table ended earlier.
bool knows_fault(const fp_agent_type& type, const char* word) {
  const bool is_there = type.abi_minor >= 5 && type.struct_size >= sizeof(fp_agent_type);
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
