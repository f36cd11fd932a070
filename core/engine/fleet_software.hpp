#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// A program, and the parameters that each of its agents gets. Both outlive the run.
struct RoleSoftware {
  const fp_agent_type* type = nullptr;
  const char* config = "";
};

// The control software of a run: one program on board of all AGVs, and one for each computer of the scenario. Programs
// on board alone are the special case without computers.
struct FleetSoftware {
  RoleSoftware on_board;
  std::vector<RoleSoftware> computers;

  FleetSoftware(const fp_agent_type& agent, const char* config) : on_board{&agent, config} {}
  FleetSoftware(RoleSoftware vehicles, std::vector<RoleSoftware> servers)
      : on_board(vehicles), computers(std::move(servers)) {}

  // Requires: the scenario has as many computers.
  const RoleSoftware& of(const Scenario& scenario, EntityId participant) const {
    return scenario.is_agv(participant) ? on_board : computers[participant.index() - scenario.agvs.size()];
  }
};

// Why a program does not run on this computer, of one that serves AGVs only.
std::string why_not_on_computer(std::string_view program, std::string_view computer);
// Throws InputError if a computer has no program, or one that cannot serve it.
void check_roles(const Scenario& scenario, const FleetSoftware& software);

}  // namespace fleetproof
