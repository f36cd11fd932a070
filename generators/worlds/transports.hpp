#pragma once

#include <cstdint>
#include <vector>

#include "core/base/words.hpp"
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

// Whose the transports of a world are: each AGV has its own, or all are open.
enum class OrderKind : std::uint8_t { Assigned, Open };
constexpr const char* name_of(OrderKind kind) {
  switch (kind) {
    case OrderKind::Assigned:
      return "assigned";
    case OrderKind::Open:
      return "open";
  }
  return kNoWord;
}

struct OrderSetup {
  OrderKind transports = OrderKind::Assigned;
  double withdrawn_share = 0.0;  // probability that a transport is withdrawn, within five minutes of its release

  friend bool operator==(const OrderSetup&, const OrderSetup&) = default;
};

// Where transports begin and end, in ascending order. Every pick has another station where its loads can be dropped.
struct OrderEnds {
  std::vector<StationId> picks, drops;             // both empty: no AGV can bring a load from one station to another
  std::vector<std::vector<StationId>> drops_of{};  // by pick; none: loads get from every pick to every drop
  bool storage = false;                            // all of them are for storage

  // Where loads of the pick with this number can be dropped.
  const std::vector<StationId>& drops_from(std::size_t pick) const { return drops_of.empty() ? drops : drops_of[pick]; }
};

// For AGVs of this type (reachability.hpp): the storage stations of the core where they can pick, and those where they
// can drop. If these allow no transport: all stations that may_end_orders(). If those allow none either: all stations.
OrderEnds order_ends(const LogicalMap& map, const Reachability& reachability, std::uint32_t type = 0);

// False for a station that is for charging or parking only.
bool may_end_orders(const Station& station);

// By type of the fleet.
std::vector<OrderEnds> order_ends_by_type(const Scenario& scenario, const Reachability& reachability);

// Gives every AGV a Poisson process of transports until the horizon, between two different stations of order_ends().
// The first transport is released within the first 10 s. Each AGV has its own draws, so a larger fleet or a longer
// horizon only adds transports. `key` is the key of the transports stream, `attempt` its topic. Returns false if they
// do not all lead between stations for storage. Without order ends, or with rate 0, nothing is assigned.
bool assign_transports(Scenario& scenario, const Demand& demand, const Reachability& reachability, std::uint64_t key,
                       std::uint32_t attempt);

// Draws which transports of the AGVs are withdrawn, and when. `key` and `attempt` as above; no other draw has these
// keys.
void withdraw_transports(Scenario& scenario, double share, std::uint64_t key, std::uint32_t attempt);

// Makes the transports of all AGVs open ones, in order of release. The faults at a transport stay with it. A load falls
// clear of the longest AGV of the fleet.
void open_transports(Scenario& scenario);

}  // namespace fleetproof
