#include "core/engine/notes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/engine/call_limits.hpp"

namespace fleetproof {
namespace {

constexpr double kFarthest_m = 2e6;

bool is_within(double value, double limit) { return std::abs(value) <= limit; }  // false also for NaN

std::int16_t heading_units(double part) {
  return static_cast<std::int16_t>(std::lround(std::clamp(part, -1.0, 1.0) * NotedPose::kHeadingUnits));
}

}  // namespace

std::optional<std::string_view> noted(const char* text) {
  if (text == nullptr) return std::nullopt;
  return std::string_view(text, ::strnlen(text, kNoteBytesMax));
}

std::optional<NotedPose> noted(const fp_pose* where) {
  if (where == nullptr || !is_within(where->x_m, kFarthest_m) || !is_within(where->y_m, kFarthest_m) ||
      !is_within(where->heading_x, 2.0) || !is_within(where->heading_y, 2.0))
    return std::nullopt;
  return NotedPose{static_cast<std::int32_t>(std::lround(where->x_m * 1e3)),
                   static_cast<std::int32_t>(std::lround(where->y_m * 1e3)), heading_units(where->heading_x),
                   heading_units(where->heading_y)};
}

fp_pose as_given(const NotedPose& pose) {
  return {pose.x_mm / 1e3, pose.y_mm / 1e3, pose.heading_x / NotedPose::kHeadingUnits,
          pose.heading_y / NotedPose::kHeadingUnits};
}

}  // namespace fleetproof
