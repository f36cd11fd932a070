#include "generators/formats/heading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

constexpr double kQuarterTurn_rad = kPi / 2.0;
constexpr double kRounded_rad = 0.002;
constexpr double kNearLane_rad = kPi / 180.0;

}  // namespace

Vec2 heading_at(double angle_rad) {
  const double quarters = std::round(angle_rad / kQuarterTurn_rad);
  if (std::abs(angle_rad - quarters * kQuarterTurn_rad) > kRounded_rad) return unit_vector(angle_rad);
  const std::array<Vec2, 4> headings = {Vec2(1.0, 0.0), Vec2(0.0, 1.0), Vec2(-1.0, 0.0), Vec2(0.0, -1.0)};
  const auto whole = static_cast<std::int64_t>(quarters);
  return headings[static_cast<std::size_t>((whole % 4 + 4) % 4)];
}

std::vector<std::string> settle_headings(Layout& layout) {
  if (std::ranges::none_of(layout.stations, [](const Station& s) { return s.heading.has_value(); })) return {};
  const LogicalMap map(layout);
  std::vector<double> nearest_rad(layout.stations.size(), kNearLane_rad);
  std::vector<std::optional<Vec2>> arrived(layout.stations.size());
  for (const Lane& lane : map.lanes()) {
    const auto i = lane.to.index();
    const auto& asked = layout.stations[i].heading;
    if (!asked) continue;
    const double off_rad = std::abs(angle_between(*asked, lane.end_heading()));
    if (off_rad >= nearest_rad[i]) continue;
    nearest_rad[i] = off_rad;
    arrived[i] = lane.end_heading();
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < layout.stations.size(); ++i) {
    if (layout.stations[i].heading && !arrived[i]) names.push_back(layout.stations[i].name);
    layout.stations[i].heading = arrived[i];
  }
  return names;
}

}  // namespace fleetproof
