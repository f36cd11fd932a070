#include "core/scenario/lane_rules.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/tolerances.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

bool aligned(const Vec2& a, const Vec2& b) { return std::abs(angle_between(a, b)) <= kAligned_rad; }

}  // namespace

bool has_rules(const Layout& layout) {
  return std::ranges::any_of(layout.stations, &Station::has_rules) ||
         std::ranges::any_of(layout.segments, [](const Segment& s) { return !s.permissions.empty(); });
}

bool LaneRules::may_drive(const Lane& lane, const Vec2& heading) const {
  return map.segment(lane.segment).permits(vehicle_type, loaded) &&
         (map.station(lane.from).turning || aligned(heading, lane.start_heading()));
}

bool LaneRules::may_stay(StationId station, const Vec2& heading) const {
  const auto& wanted = map.station(station).heading;
  return !wanted || aligned(heading, *wanted);
}

}  // namespace fleetproof
