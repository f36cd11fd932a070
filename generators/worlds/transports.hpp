#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "generators/map/reachability.hpp"

namespace fleetproof {

// How many transports, and how unequally they fall on the stations.
struct Demand {
  double transports_per_agv_hour = 20.0;
  // Exponent of Zipf's law: the n-th busiest station is n^-skew times as busy as the busiest; which one that is, is
  // drawn. 0: all equally.
  double hot_spot_skew = 0.0;
};

// Gives every AGV a Poisson process of transports until the horizon, the first released within the first 10 s, between
// two different stations of order_ends(). Each AGV draws for itself: `key` is that of the transports stream, `attempt`
// its topic; neither fleet size nor horizon changes what came before. Returns false if fewer than two stations of the
// core are for storage. Without two stations or with rate 0 nothing is assigned.
bool assign_transports(Scenario& scenario, const Demand& demand, const Reachability& reachability, std::uint64_t key,
                       std::uint32_t attempt);

// Not a station for charging or parking only.
bool may_end_orders(const Station& station);

// Stations of the core where transports begin and end: those for storage or, if they are fewer than two, all that
// may_end_orders(), or, if these are fewer than two, all.
std::vector<StationId> order_ends(const LogicalMap& map, const Reachability& reachability);

}  // namespace fleetproof
