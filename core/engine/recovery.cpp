#include "core/engine/recovery.hpp"

#include "core/scenario/ways.hpp"

namespace fleetproof {
namespace {

Pose arrival(const Lane& lane) { return lane.curve.pose_at(lane.curve.length_m()); }

}  // namespace

std::vector<RecoveryPlace> recovery_places(const LogicalMap& map, StationId station, const Lane* stopped_on,
                                           const Pose& stood) {
  const StationId first = stopped_on != nullptr ? stopped_on->to : station;
  const Pose first_pose = stopped_on != nullptr ? arrival(*stopped_on) : stood;
  std::vector<RecoveryPlace> places;
  for (const ShortestWay& way : shortest_ways(map, first))
    places.push_back({way.to, way.last == nullptr ? first_pose : arrival(*way.last)});
  return places;
}

}  // namespace fleetproof
