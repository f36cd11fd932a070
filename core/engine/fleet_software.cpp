#include "core/engine/fleet_software.hpp"

#include <string>

#include "core/base/error.hpp"

namespace fleetproof {

void check_roles(const Scenario& scenario, const FleetSoftware& software) {
  if (software.computers.size() != scenario.computers.size()) {
    throw InputError("computers", "the scenario has " + std::to_string(scenario.computers.size()) + ", and there are " +
                                      std::to_string(software.computers.size()) +
                                      " programs for them; give each computer one");
  }
  for (std::size_t i = 0; i < scenario.computers.size(); ++i) {
    const fp_agent_type& type = *software.computers[i].type;
    if (type.abi_minor >= 5 && (type.flags & FP_SERVES_COMPUTERS) != 0) continue;
    throw InputError(type.name, "does not serve computers, so it cannot be the program of '" +
                                    scenario.computers[i].name +
                                    "'; choose another, or set FP_SERVES_COMPUTERS in its fp_agent_type");
  }
}

}  // namespace fleetproof
