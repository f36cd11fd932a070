#include "generators/timetable.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/rotation.hpp"
#include "core/motion_profile.hpp"

namespace fleetproof {
namespace {

constexpr double kAligned_rad = 1e-7;  // as the engine has it
constexpr Duration kSame = std::chrono::microseconds(1);  // no drive is so short
constexpr Duration kFar = Duration::max();
constexpr std::uint32_t kNone = QuickestWays::kNone;

}  // namespace

std::vector<std::uint32_t> QuickestWays::lanes(const LogicalMap& map, StationId station) const {
  std::vector<std::uint32_t> found;
  for (auto lane = at(station).lane; lane != kNone; lane = at(map.lanes()[lane].from).lane) found.push_back(lane);
  std::ranges::reverse(found);
  return found;
}

Timetable::Timetable(const LogicalMap& map, const VehicleType& type) : map_(map), type_(type), ways_(map.station_count()) {
  std::uint32_t turns = 0;
  hops_.reserve(map.lanes().size());
  for (const auto& lane : map.lanes()) {
    hops_.push_back({lane.from.value, lane.to.value, MotionProfile(lane.curve.length_m(), type.drive).duration(), 0, turns});
    turns += static_cast<std::uint32_t>(map.lanes_from(lane.to).size());
  }
  turns_.assign(turns, Duration{-1});
  const auto longest = std::ranges::max_element(hops_, {}, &Hop::drive);
  open_.emplace(longest == hops_.end() ? Duration::zero() : longest->drive);
  for (std::size_t s = 0; s < map.station_count(); ++s) {
    std::uint32_t place = 0;
    for (const auto lane : map.lanes_from(StationId{s})) hops_[lane].place = place++;
  }
}

const QuickestWays& Timetable::from(StationId station) {
  auto& ways = ways_[station.index()];
  if (!ways.arrivals.empty()) return ways;
  ways.from = station;
  if (!follow_only_lane(ways)) search(ways);
  return ways;
}

Duration Timetable::turn(std::uint32_t before, std::uint32_t after) const {
  Duration& known = turns_[hops_[before].first_turn + hops_[after].place];
  if (known < Duration::zero()) {
    const Curve &in = map_.lanes()[before].curve, &out = map_.lanes()[after].curve;
    const Vec2 arriving = in.pose_at(in.length_m()).heading, leaving = out.pose_at(0.0).heading;
    const double angle = arriving == leaving ? 0.0 : std::abs(angle_between(arriving, leaving));
    known = angle > kAligned_rad ? MotionProfile(angle, type_.turn).duration() : Duration::zero();
  }
  return known;
}

// From a station that only one lane leaves, as from every dead end, all ways are those from the end of that lane, and as much later.
bool Timetable::follow_only_lane(QuickestWays& ways) {
  const auto& out = map_.lanes_from(ways.from);
  if (out.size() != 1) return false;
  const auto only = out[0];
  const StationId next{hops_[only].to};
  const auto& beyond = map_.lanes_from(next);
  if (beyond.size() < 2) return false;  // it may lead round in a circle
  ways.arrivals = from(next).arrivals;
  std::vector<Duration> later(beyond.size());
  for (const auto lane : beyond) later[hops_[lane].place] = hops_[only].drive + turn(only, lane);
  for (auto& arrival : ways.arrivals) {
    if (arrival.lane == kNone) continue;
    const Duration shift = later[hops_[arrival.first].place];
    arrival.drives_off += shift;
    arrival.arrives += shift;
    arrival.first = only;
  }
  ways.arrivals[next.index()] = {Duration::zero(), hops_[only].drive, only, only, true};
  ways.arrivals[ways.from.index()] = {.unique = true};
  return true;
}

// Dijkstra in whole nanoseconds; of ways equally quick the one found first.
void Timetable::search(QuickestWays& ways) {
  auto& open = *open_;
  ways.arrivals.assign(map_.station_count(), {});
  reached_.assign(map_.station_count(), {kFar, kFar, kNone});
  reached_[ways.from.index()].cost = Duration::zero();
  open.rewind();
  open.push({0, ways.from.value});
  while (!open.empty()) {
    const auto [cost_ns, here] = open.pop();
    const Duration cost{cost_ns};
    if (cost > reached_[here].cost) continue;
    arrive(ways, here);
    for (const auto lane : map_.lanes_from(StationId{here})) {
      const auto& hop = hops_[lane];
      auto& reached = reached_[hop.to];
      const Duration there = cost + hop.drive;
      if (there < reached.cost) {
        reached = {there, reached.cost, lane};
        open.push({there.count(), hop.to});
      } else if (there < reached.next_best) {
        reached.next_best = there;
      }
    }
  }
}

// All ways to the station that are as quick as its quickest are known by now. Times with turns follow along the tree.
void Timetable::arrive(QuickestWays& ways, std::uint32_t station) const {
  const auto& reached = reached_[station];
  auto& arrival = ways.arrivals[station];
  if (reached.lane == kNone) {
    arrival.unique = true;
    return;
  }
  const auto& hop = hops_[reached.lane];
  const auto& before = ways.arrivals[hop.from];
  const bool begins = before.lane == kNone;
  arrival.lane = reached.lane;
  arrival.first = begins ? reached.lane : before.first;
  arrival.drives_off = begins ? Duration::zero() : before.arrives + turn(before.lane, reached.lane);
  arrival.arrives = arrival.drives_off + hop.drive;
  arrival.unique = before.unique && reached.next_best - reached.cost > kSame;
}

}  // namespace fleetproof
