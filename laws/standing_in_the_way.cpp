#include "laws/standing_in_the_way.hpp"

#include "core/base/tolerances.hpp"
#include "core/scenario/ways.hpp"

namespace fleetproof {
namespace {

constexpr double kPoseStep_m = 0.1;  // between poses of the way

}  // namespace

const Lane* first_lane_of_way(const LaneRules& rules, StationId from, StationId to) {
  const ShortestWay way = shortest_ways(rules.map, from, to, &rules).back();
  return way.to == to ? way.first : nullptr;
}

StationId station_of(const LogicalMap& map, const Vec2& position_m) {
  const auto& stations = map.layout().stations;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if ((stations[i].position_m - position_m).norm() <= kAtStation_m) return StationId{i};
  }
  return {};
}

EntityId first_in_the_way(const Scenario& scenario, const Whereabouts& bodies, EntityId agv, const Lane& lane,
                          SimTime now) {
  const Footprint& footprint = bodies.of(agv).footprint;
  const int steps = static_cast<int>(lane.curve.length_m() / kPoseStep_m) + 1;
  for (int step = 0; step <= steps; ++step) {
    const OrientedRectangle mine = placed(footprint, lane.curve.pose_at(lane.curve.length_m() * step / steps));
    for (std::size_t i = 0; i < bodies.body_count(); ++i) {
      const EntityId other{i};
      if (other == agv || !bodies.on_floor(other) || bodies.moves(other)) continue;
      if (clearance_m(mine, bodies.of(other).body_at(now)) < scenario.law.safety_distance_m) return other;
    }
  }
  return {};
}

}  // namespace fleetproof
