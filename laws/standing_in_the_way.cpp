#include "laws/standing_in_the_way.hpp"

#include <algorithm>
#include <limits>
#include <queue>

namespace fleetproof {
namespace {

constexpr double kStep_m = 0.1;  // between poses of the way

}  // namespace

const Lane* first_lane_of_way(const LogicalMap& map, StationId from, StationId to) {
  constexpr double kFar_m = std::numeric_limits<double>::infinity();
  std::vector<double> distance_m(map.station_count(), kFar_m);
  std::vector<const Lane*> first(map.station_count(), nullptr);
  using Reached = std::pair<double, std::uint32_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  distance_m[from.index()] = 0.0;
  queue.emplace(0.0, from.value);
  while (!queue.empty()) {
    const auto [so_far_m, at] = queue.top();
    queue.pop();
    if (so_far_m > distance_m[at]) continue;
    if (at == to.value) break;
    for (const std::uint32_t index : map.lanes_from(StationId{at})) {
      const Lane& lane = map.lanes()[index];
      const double there_m = so_far_m + lane.curve.length_m();
      if (there_m >= distance_m[lane.to.index()]) continue;
      distance_m[lane.to.index()] = there_m;
      first[lane.to.index()] = at == from.value ? &lane : first[at];
      queue.emplace(there_m, lane.to.value);
    }
  }
  return from == to ? nullptr : first[to.index()];
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
  const int steps = static_cast<int>(lane.curve.length_m() / kStep_m) + 1;
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
