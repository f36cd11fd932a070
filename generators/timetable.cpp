#include "generators/timetable.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
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
  for (const auto& lane : map.lanes()) {
    hops_.push_back({lane.from.value, lane.to.value, MotionProfile(lane.curve.length_m(), type.drive).duration()});
    headings_.emplace_back(lane.curve.pose_at(0.0).heading, lane.curve.pose_at(lane.curve.length_m()).heading);
    turns_.emplace_back(map.lanes_from(lane.to).size(), Duration{-1});
  }
}

const QuickestWays& Timetable::from(StationId station) {
  if (!known_[station.index()]) {
    ways_[station.index()] = search(station);
    known_[station.index()] = true;
  }
  return ways_[station.index()];
}

Duration Timetable::turn(std::uint32_t before, std::uint32_t after) {
  const auto& next = map_.lanes_from(map_.lanes()[before].to);
  Duration& known = turns_[before][static_cast<std::size_t>(std::ranges::find(next, after) - next.begin())];
  if (known < Duration::zero()) {
    const double angle = std::abs(angle_between(headings_[before].second, headings_[after].first));
    known = angle > kAligned_rad ? MotionProfile(angle, type_.turn).duration() : Duration::zero();
  }
  return known;
}

// Dijkstra in whole nanoseconds; of ways equally quick the one found first. Times with turns follow along the tree.
QuickestWays Timetable::search(StationId from) {
  const auto n = map_.station_count();
  QuickestWays w{from, std::vector(n, QuickestWays::kNone), std::vector(n, Duration{}), std::vector(n, Duration{}), std::vector<std::uint8_t>(n, 0)};
  cost_.assign(n, kFar);
  order_.clear();
  cost_[from.index()] = Duration::zero();
  open_.assign(1, {Duration::zero(), from.value});
  while (!open_.empty()) {
    std::ranges::pop_heap(open_, std::greater<>());
    const auto [cost, here] = open_.back();
    open_.pop_back();
    if (cost > cost_[here]) continue;
    order_.push_back(here);
    for (const auto lane : map_.lanes_from(StationId{here})) {
      const auto& hop = hops_[lane];
      if (cost + hop.drive >= cost_[hop.to]) continue;
      cost_[hop.to] = cost + hop.drive;
      w.arrival_lane[hop.to] = lane;
      open_.emplace_back(cost_[hop.to], hop.to);
      std::ranges::push_heap(open_, std::greater<>());
    }
  }
  quickest_.assign(n, 0);  // lanes by which one is as quick as it gets
  for (const auto& hop : hops_) {
    if (cost_[hop.from] != kFar && cost_[hop.from] + hop.drive <= cost_[hop.to] + kSame) ++quickest_[hop.to];
  }
  w.unique[from.index()] = 1;
  for (const auto station : order_) {
    const auto lane = w.arrival_lane[station];
    if (lane == QuickestWays::kNone) continue;
    const auto before = hops_[lane].from;
    const auto earlier = w.arrival_lane[before];
    w.drives_off[station] = w.arrives[before] + (earlier == QuickestWays::kNone ? Duration::zero() : turn(earlier, lane));
    w.arrives[station] = w.drives_off[station] + hops_[lane].drive;
    w.unique[station] = w.unique[before] != 0 && quickest_[station] == 1 ? 1 : 0;
  }
  return w;
}

}  // namespace fleetproof
