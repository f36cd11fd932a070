#pragma once

#include <vector>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// A scenario whose radio draws, with little bad luck instead of much: all messages of a short time are lost, late or
// doubled; or few messages are lost at all. Short times and times close to `failure` come first.
std::vector<Scenario> with_sparse_luck(const Scenario& scenario, SimTime failure);

}  // namespace fleetproof
