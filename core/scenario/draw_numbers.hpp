#pragma once

#include <algorithm>
#include <vector>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The number under which the draws of each AGV are made, see AgvSetup::draws_as.
class DrawNumbers {
 public:
  DrawNumbers() = default;  // each AGV has its place in the fleet
  explicit DrawNumbers(const Scenario& scenario) {
    if (std::ranges::none_of(scenario.agvs, [](const AgvSetup& agv) { return agv.draws_as.has_value(); })) return;
    for (std::size_t i = 0; i < scenario.agvs.size(); ++i)
      numbers_.emplace_back(scenario.agvs[i].draws_as.value_or(static_cast<std::uint32_t>(i)));
  }

  // Whether each AGV has its place in the fleet.
  bool are_places() const { return numbers_.empty(); }
  AgvId of(AgvId agv) const { return numbers_.empty() ? agv : numbers_[agv.index()]; }

 private:
  std::vector<AgvId> numbers_;  // by AGV; empty: each its own
};

}  // namespace fleetproof
