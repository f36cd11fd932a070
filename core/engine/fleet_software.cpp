#include "core/engine/fleet_software.hpp"

#include "core/base/error.hpp"
#include "core/base/outside_text.hpp"
#include "core/sdk/agent_table.hpp"

namespace fleetproof {

std::string why_not_on_computer(std::string_view program, std::string_view computer) {
  return in_quotes(program) + " does not serve computers, so it cannot be the program of " + in_quotes(computer) +
         "; choose another, or set FP_SERVES_COMPUTERS among the flags of its fp_agent_type (of agent_type<...>())";
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
