#pragma once

#include <string_view>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Whether a layout forbids anything to anyone: by permissions, or at its stations.
bool has_rules(const Layout& layout);

// What the plant allows an AGV at a station and on a lane. The controller refuses everything else.
struct LaneRules {
  const LogicalMap& map;
  std::string_view vehicle_type;  // empty: a vehicle that has the permissions of every type
  bool loaded = false;

  // Whether an AGV whose nose has this heading may leave by this lane: it has the permission, and if it would have to
  // turn on the spot, it may.
  bool may_drive(const Lane& lane, const Vec2& heading) const;
  // Whether it may pick, drop, park or charge with this heading.
  bool may_stay(StationId station, const Vec2& heading) const;
};

}  // namespace fleetproof
