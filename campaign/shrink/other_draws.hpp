#pragma once

#include <cstdint>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The same scenario with other draws of the radio and of the agents. Each number gives other ones.
Scenario with_other_draws(Scenario scenario, std::uint32_t number);
// Of the radio alone.
Scenario with_other_radio(Scenario scenario, std::uint32_t number);
// So much later an order or a fault may come on another timeline.
inline constexpr Duration kLatest = std::chrono::seconds(5);
// Of radio, agents and motion; the orders and the faults of each AGV come up to `later` later, another time for each.
// On a perfect radio, too, the AGVs meet otherwise then.
Scenario with_other_timeline(Scenario scenario, std::uint32_t number, Duration later);

}  // namespace fleetproof
