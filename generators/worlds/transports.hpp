#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "generators/map/reachability.hpp"

namespace fleetproof {

// How many transports there are, and how unequally stations are used.
struct Demand {
  double transports_per_agv_hour = 30.0;  // 0: none
  // Exponent of Zipf's law: the n-th busiest station is n^-skew times as busy as the busiest. The order of the stations
  // is drawn. 0: all stations are equally busy.
  double hot_spot_skew = 0.0;
};

// Gives every AGV a Poisson process of transports until the horizon, between two different stations of order_ends().
// The first transport is released within the first 10 s. Each AGV has its own draws, so a larger fleet or a longer
// horizon only adds transports. `key` is the key of the transports stream, `attempt` its topic. Returns false if fewer
// than two stations of the core are for storage. Without two stations, or with rate 0, nothing is assigned.
bool assign_transports(Scenario& scenario, const Demand& demand, const Reachability& reachability, std::uint64_t key,
                       std::uint32_t attempt);

// False for a station that is for charging or parking only.
bool may_end_orders(const Station& station);

// The stations of the core at which transports begin and end: the storage stations. If there are fewer than two, all
// stations that may_end_orders(). If there are still fewer than two, all stations.
std::vector<StationId> order_ends(const LogicalMap& map, const Reachability& reachability);

}  // namespace fleetproof
