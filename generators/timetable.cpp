#include "generators/timetable.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "core/geometry/rotation.hpp"
#include "core/motion_profile.hpp"

namespace fleetproof {
namespace {

constexpr double kAligned_rad = 1e-7;  // as the engine has it
constexpr Duration kSame = std::chrono::microseconds(1);
constexpr Duration kFar = Duration::max();

}  // namespace

std::vector<std::uint32_t> QuickestWays::lanes(const LogicalMap& map, StationId station) const {
  std::vector<std::uint32_t> found;
  for (auto lane = arrival_lane[station.index()]; lane != kNone; lane = arrival_lane[map.lanes()[lane].from.index()]) found.push_back(lane);
  std::ranges::reverse(found);
  return found;
}

Timetable::Timetable(const LogicalMap& map, const VehicleType& type)
    : map_(map), type_(type), ways_(map.station_count()), known_(map.station_count(), false) {
  for (const auto& lane : map.lanes()) drive_.push_back(MotionProfile(lane.curve.length_m(), type.drive).duration());
}

const QuickestWays& Timetable::from(StationId station) {
  if (!known_[station.index()]) {
    ways_[station.index()] = search(station);
    known_[station.index()] = true;
  }
  return ways_[station.index()];
}

Duration Timetable::turn(std::uint32_t before, std::uint32_t after) const {
  const auto& end = map_.lanes()[before].curve;
  const double angle = std::abs(angle_between(end.pose_at(end.length_m()).heading, map_.lanes()[after].curve.pose_at(0.0).heading));
  return angle > kAligned_rad ? MotionProfile(angle, type_.turn).duration() : Duration::zero();
}

// Dijkstra in whole nanoseconds; of ways equally quick the one found first. Times with turns follow along the tree.
QuickestWays Timetable::search(StationId from) const {
  const auto n = map_.station_count();
  const auto& lanes = map_.lanes();
  QuickestWays w{from, std::vector(n, QuickestWays::kNone), std::vector(n, Duration{}), std::vector(n, Duration{}), std::vector(n, false)};
  std::vector<Duration> cost(n, kFar);
  std::vector<bool> settled(n, false);
  std::vector<std::uint32_t> order;
  using Open = std::pair<Duration, std::uint32_t>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  cost[from.index()] = Duration::zero();
  open.push({Duration::zero(), static_cast<std::uint32_t>(from.index())});
  while (!open.empty()) {
    const auto here = open.top().second;
    open.pop();
    if (settled[here]) continue;
    settled[here] = true;
    order.push_back(here);
    for (const auto lane : map_.lanes_from(StationId{here})) {
      const auto to = lanes[lane].to.index();
      if (settled[to] || cost[here] + drive_[lane] >= cost[to]) continue;
      cost[to] = cost[here] + drive_[lane];
      w.arrival_lane[to] = lane;
      open.push({cost[to], static_cast<std::uint32_t>(to)});
    }
  }
  std::vector<std::uint32_t> quickest(n, 0);  // lanes by which one is as quick as it gets
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    const auto a = lanes[i].from.index(), b = lanes[i].to.index();
    if (cost[a] != kFar && cost[a] + drive_[i] <= cost[b] + kSame) ++quickest[b];
  }
  w.unique[from.index()] = true;
  for (const auto station : order) {
    const auto lane = w.arrival_lane[station];
    if (lane == QuickestWays::kNone) continue;
    const auto before = lanes[lane].from.index();
    const auto earlier = w.arrival_lane[before];
    w.drives_off[station] = w.arrives[before] + (earlier == QuickestWays::kNone ? Duration::zero() : turn(earlier, lane));
    w.arrives[station] = w.drives_off[station] + drive_[lane];
    w.unique[station] = w.unique[before] && quickest[station] == 1;
  }
  return w;
}

}  // namespace fleetproof
