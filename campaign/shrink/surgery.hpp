#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/scenario/scenario.hpp"

// Scenarios with something taken out of them. What referred to it goes with it; all else keeps its place, its time and
// its draws.
namespace fleetproof {

// Whether the thing at this place of a list stays.
using Keeps = std::function<bool(std::size_t place)>;

// AGVs with their orders, faults and messages. The others keep the numbers under which they draw.
Scenario with_agvs(const Scenario& scenario, const Keeps& keeps);

// If a computer is taken out, so are its faults and messages. What is random about the others stays the same.
Scenario with_computers(const Scenario& scenario, const Keeps& keeps);

// The same fleet, numbered from AGV `first` on, and then from 0: with its orders, faults, messages and draws.
// Requires: there is such an AGV.
Scenario with_fleet_renumbered(const Scenario& scenario, std::size_t first);

// `keeps` counts transports as OrderTable does. Faults at a transport go with it.
Scenario with_transports(const Scenario& scenario, const Keeps& keeps);

// Segments, and the stations that are left without a segment and without an AGV or an order there. Blocks stay.
// Requires: no script uses a segment that goes.
Scenario with_segments(const Scenario& scenario, const Keeps& keeps);

// The items of a list that stay.
template <class Item>
std::vector<Item> kept(const std::vector<Item>& items, const Keeps& keeps) {
  std::vector<Item> left;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (keeps(i)) left.push_back(items[i]);
  }
  return left;
}

}  // namespace fleetproof
