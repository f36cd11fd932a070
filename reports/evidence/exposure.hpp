#pragma once

#include <cstdint>

#include "core/outcome/outcome.hpp"

namespace fleetproof {

// Exposure is counted in whole microseconds of one AGV, so that sums do not depend on their order.
inline constexpr double kAgvUsPerHour = 3.6e9;
inline std::uint64_t agv_us(const Outcome& outcome) { return outcome.simulated_ns / 1000 * outcome.agv_count; }
constexpr double agv_hours(std::uint64_t agv_us) { return static_cast<double>(agv_us) / kAgvUsPerHour; }

}  // namespace fleetproof
