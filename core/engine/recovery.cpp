#include "core/engine/recovery.hpp"

#include <algorithm>

#include "core/scenario/ways.hpp"

namespace fleetproof {
namespace {

Pose arrival(const Lane& lane) { return lane.curve.pose_at(lane.curve.length_m()); }

bool may_drive_off(const LaneRules& rules, const RecoveryPlace& place) {
  const auto& lanes = rules.map.lanes_from(place.station);
  return lanes.empty() || std::ranges::any_of(lanes, [&](std::uint32_t lane) {
           return rules.may_drive(rules.map.lanes()[lane], place.pose.heading);
         });
}

}  // namespace

std::vector<RecoveryPlace> recovery_places(const LaneRules& rules, StationId station, const Lane* stopped_on,
                                           const Pose& stood) {
  const StationId first = stopped_on != nullptr ? stopped_on->to : station;
  const Pose first_pose = stopped_on != nullptr ? arrival(*stopped_on) : stood;
  std::vector<RecoveryPlace> places;
  for (const ShortestWay& way : shortest_ways(rules.map, first)) {
    RecoveryPlace place{way.to, way.last == nullptr ? first_pose : arrival(*way.last)};
    place.pose.heading = rules.map.station(way.to).heading.value_or(place.pose.heading);
    if (may_drive_off(rules, place)) places.push_back(place);
  }
  return places;
}

}  // namespace fleetproof
