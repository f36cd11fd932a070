#pragma once

#include <vector>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// A scenario whose radio draws, with few losses and delays instead of many: all messages of a short time are lost,
// late or doubled; or few messages are lost at all. Short times and times close to `failure` come first.
std::vector<Scenario> with_sparse_losses(const Scenario& scenario, SimTime failure);

}  // namespace fleetproof
