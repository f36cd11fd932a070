#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fleetproof {

// The range of a layout family. Normal: usual warehouses. Stress: warehouses that break control software.
enum class Range : std::uint8_t { Normal, Stress };

inline constexpr std::string_view kStressSuffix = "/stress";

// "aisle-grid" or "aisle-grid/stress": the name of such layouts in cells and on pages.
inline std::string family_name(std::string_view family, Range range) {
  return std::string(family) + std::string(range == Range::Stress ? kStressSuffix : "");
}

}  // namespace fleetproof
