#pragma once

#include <algorithm>
#include <vector>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The number under which the draws of each participant are made, see AgvSetup::draws_as. Computers count from the last
// number down: what is drawn for them does not change with the size of the fleet.
class DrawNumbers {
 public:
  static constexpr std::uint32_t kLast = 0xffff;  // two numbers are one word of a key

  DrawNumbers() = default;  // each AGV has its place in the fleet
  explicit DrawNumbers(const Scenario& scenario) {
    const bool own = std::ranges::any_of(scenario.agvs, [](const AgvSetup& agv) { return agv.draws_as.has_value(); });
    if (!own && scenario.computers.empty()) return;
    for (std::size_t i = 0; i < scenario.agvs.size(); ++i)
      numbers_.emplace_back(scenario.agvs[i].draws_as.value_or(static_cast<std::uint32_t>(i)));
    for (std::size_t i = 0; i < scenario.computers.size(); ++i)
      numbers_.emplace_back(kLast - scenario.computers[i].draws_as.value_or(static_cast<std::uint32_t>(i)));
  }

  // Whether each participant is an AGV that has its place in the fleet.
  bool are_places() const { return numbers_.empty(); }
  EntityId of(EntityId participant) const { return numbers_.empty() ? participant : numbers_[participant.index()]; }

 private:
  std::vector<EntityId> numbers_;  // by participant; empty: each its own
};

}  // namespace fleetproof
