// Open orders: transports of no AGV, which the program of a fleet gives to its AGVs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// A load to be carried from one station to another.
struct Order {
  std::uint32_t id = FP_NONE, from = FP_NONE, to = FP_NONE;
  friend bool operator==(const Order&, const Order&) = default;
  void fields(auto& io) { io(id, from, to); }
};

struct OpenOrder {
  Order order;
  std::uint32_t agv = FP_NONE;  // the one that is to carry it out
};

// Gives orders to AGVs that are free, each of them one: the oldest order first, to the AGV that is there first.
// `orders`: the oldest first. `takes_s(agv, station)`: the time until the AGV is there; infinite if it cannot go there.
// `give(agv, order)` is called for each order that has got an AGV.
template <class TakesTime, class Give>
void assign(std::span<OpenOrder> orders, std::vector<std::uint32_t> free_agvs, TakesTime takes_s, Give give) {
  for (OpenOrder& open : orders) {
    if (free_agvs.empty()) return;
    if (open.agv != FP_NONE) continue;
    double best_s = INFINITY;
    for (const std::uint32_t agv : free_agvs) {
      const double time_s = takes_s(agv, open.order.from);
      if (time_s < best_s) open.agv = agv, best_s = time_s;
    }
    if (open.agv == FP_NONE) continue;
    std::erase(free_agvs, open.agv);
    give(open.agv, open.order);
  }
}

}  // namespace fleetproof::agents
