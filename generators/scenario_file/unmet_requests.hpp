// What a scenario asks for and cannot get, as far as this can be known before a run.
#pragma once

#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// One thing that will not happen in any run of the scenario. `sentence`: value, what is wrong, remedy.
struct UnmetRequest {
  std::string pointer;  // JSON pointer to the field in the scenario file
  std::string sentence;
};

// Orders, scripted calls, faults, obstacles, given deliveries and help of which the instant is after the end of the
// run; obstacles where another one stands all the time; loads that nobody carries, or that would fall on their own AGV;
// scripts that no agent plays; radio that is never adverse; fields that count only beside another one, which is off.
// Many of one kind at one AGV are one request. A run files most of them as incidents of the role Denied. Requires: the
// scenario can be run (unusable_problems).
std::vector<UnmetRequest> unmet_requests(const Scenario& scenario);

}  // namespace fleetproof
