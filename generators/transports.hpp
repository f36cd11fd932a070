#pragma once

#include <cstdint>

#include "core/scenario.hpp"
#include "generators/reachability.hpp"

namespace fleetproof {

// Gives every AGV a Poisson process of transports until the horizon, the first released within the first 10 s, between two different
// storage stations of the strongly connected core. Each AGV draws for itself: `key` is that of the transports stream, `attempt` its
// topic; neither fleet size nor horizon changes what came before. Returns false if fewer than two such stations are for storage: then
// any two of the core serve. Without two stations or with rate 0 nothing is assigned.
bool assign_transports(Scenario& scenario, double transports_per_agv_hour, const Reachability& reachability, std::uint64_t key,
                       std::uint32_t attempt);

}  // namespace fleetproof
