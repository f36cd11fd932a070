#include "core/engine/recovery.hpp"

#include <limits>
#include <queue>

namespace fleetproof {
namespace {

Pose arrival(const Lane& lane) { return lane.curve.pose_at(lane.curve.length_m()); }

}  // namespace

std::vector<RecoveryPlace> recovery_places(const LogicalMap& map, StationId station, const Lane* stopped_on,
                                           const Pose& stood) {
  using Reached = std::pair<double, std::uint32_t>;
  std::vector<double> distance_m(map.station_count(), std::numeric_limits<double>::infinity());
  std::vector<Pose> poses(map.station_count());
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  const StationId first = stopped_on != nullptr ? stopped_on->to : station;
  poses[first.index()] = stopped_on != nullptr ? arrival(*stopped_on) : stood;
  distance_m[first.index()] = 0.0;
  queue.emplace(0.0, first.value);
  std::vector<RecoveryPlace> places;
  while (!queue.empty()) {
    const auto [so_far_m, at] = queue.top();
    queue.pop();
    if (so_far_m > distance_m[at]) continue;
    places.push_back({StationId{at}, poses[at]});
    for (const std::uint32_t index : map.lanes_from(StationId{at})) {
      const Lane& lane = map.lanes()[index];
      const double there_m = so_far_m + lane.curve.length_m();
      if (there_m >= distance_m[lane.to.index()]) continue;
      distance_m[lane.to.index()] = there_m;
      poses[lane.to.index()] = arrival(lane);
      queue.emplace(there_m, lane.to.value);
    }
  }
  return places;
}

}  // namespace fleetproof
