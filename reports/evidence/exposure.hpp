#pragma once

#include <cstdint>

namespace fleetproof {

// Exposure is counted in whole microseconds of one AGV, so that sums do not depend on their order.
inline constexpr double kAgvUsPerHour = 3.6e9;
// Of one run.
constexpr std::uint64_t agv_us(std::uint64_t simulated_ns, std::uint32_t agv_count) {
  return simulated_ns / 1000 * agv_count;
}
constexpr double agv_hours(std::uint64_t agv_us) { return static_cast<double>(agv_us) / kAgvUsPerHour; }

}  // namespace fleetproof
