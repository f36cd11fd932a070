#include "generators/map/timetable.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/tolerances.hpp"
#include "core/geometry/rotation.hpp"
#include "core/motion/motion_profile.hpp"

namespace fleetproof {
namespace {

constexpr Duration kSame = std::chrono::microseconds(1);  // no drive is so short
constexpr std::uint32_t kNone = QuickestWays::kNone;

}  // namespace

std::vector<std::uint32_t> QuickestWays::lanes(const LogicalMap& map, StationId station) const {
  const auto before = [&](std::uint32_t lane) { return at(map.lanes()[lane].from).lane; };
  std::size_t count = 0;
  for (auto lane = at(station).lane; lane != kNone; lane = before(lane)) ++count;
  std::vector<std::uint32_t> found(count);
  for (auto lane = at(station).lane; lane != kNone; lane = before(lane)) found[--count] = lane;
  return found;
}

Timetable::Timetable(const LogicalMap& map, const VehicleType& type)
    : map_(map), type_(type), ways_(map.station_count()) {
  std::uint32_t turns = 0;
  hops_.reserve(map.lanes().size());
  for (const auto& lane : map.lanes()) {
    hops_.push_back(
        {lane.from.value, lane.to.value,
         MotionProfile(lane.curve.length_m(), lane.limits(type.drive_with(false, lane.is_backward()))).duration(), 0,
         turns});
    turns += static_cast<std::uint32_t>(map.lanes_from(lane.to).size());
  }
  turns_.assign(turns, Duration{-1});
  const auto longest = std::ranges::max_element(hops_, {}, &Hop::drive);
  open_.emplace(longest == hops_.end() ? Duration::zero() : longest->drive);
  for (std::size_t s = 0; s < map.station_count(); ++s) {
    std::uint32_t place = 0;
    for (const auto lane : map.lanes_from(StationId{s})) hops_[lane].place = place++;
  }
  find_ways_on();
}

const QuickestWays& Timetable::from(StationId station) {
  auto& ways = ways_[station.index()];
  if (!ways.arrivals.empty()) return ways;
  ways.from = station;
  if (!follow(ways)) search(ways);
  return ways;
}

void Timetable::forget() {
  for (auto& ways : ways_) ways.arrivals = {};
  searches_ = 0;
}

Duration Timetable::turn(std::uint32_t before, std::uint32_t after) const {
  Duration& known = turns_[hops_[before].first_turn + hops_[after].place];
  if (known < Duration::zero()) known = duration_of_turn(before, after);
  return known;
}

Duration Timetable::duration_of_turn(std::uint32_t before, std::uint32_t after) const {
  const Curve &in = map_.lanes()[before].curve, &out = map_.lanes()[after].curve;
  const Vec2 arriving = in.pose_at(in.length_m()).heading, leaving = out.pose_at(0.0).heading;
  const double angle = arriving == leaving ? 0.0 : std::abs(angle_between(arriving, leaving));
  return angle > kAligned_rad ? MotionProfile(angle, type_.turn.as_motion()).duration() : Duration::zero();
}

// A dead end beside the way does not count: its only lane leads back.
void Timetable::find_ways_on() {
  std::vector<std::uint32_t> lanes_to(map_.station_count(), 0);
  for (const auto& hop : hops_) ++lanes_to[hop.to];
  const auto is_dead_end = [&](const Hop& hop) {
    const auto& back = map_.lanes_from(StationId{hop.to});
    return lanes_to[hop.to] == 1 && back.size() == 1 && hops_[back[0]].to == hop.from;
  };
  onward_.assign(map_.station_count(), kNone);
  for (std::size_t s = 0; s < map_.station_count(); ++s) {
    std::uint32_t ways_on = 0;
    for (const auto lane : map_.lanes_from(StationId{s})) {
      if (is_dead_end(hops_[lane])) continue;
      onward_[s] = lane;
      ++ways_on;
    }
    if (ways_on > 1) onward_[s] = kNone;
  }
}

// The lanes from a station with only one way on. They end at a station with more ways, or at a station from which all
// ways are known. The stations of a one-way loop are searched once. Empty if there is nothing to follow.
std::span<const std::uint32_t> Timetable::followed_from(StationId start) {
  followed_.clear();
  StationId end = start;
  while (onward_[end.index()] != kNone && (end == start || ways_[end.index()].arrivals.empty())) {
    followed_.push_back(onward_[end.index()]);
    end = StationId{hops_[followed_.back()].to};
    if (end == start) return {};
    if (followed_.size() <= map_.station_count()) continue;
    // A circle that does not lead back to the start: the lanes up to the first station of the circle.
    const auto first = std::ranges::find(followed_, end.value, [&](std::uint32_t lane) { return hops_[lane].to; });
    followed_.erase(first + 1, followed_.end());
    break;
  }
  return followed_;
}

// The stations on the way along those lanes and the dead ends beside it, into passed_. Returns when the last lane ends.
Duration Timetable::pass(std::span<const std::uint32_t> followed) {
  passed_.clear();
  Duration arrives{};
  for (std::size_t i = 0; i < followed.size(); ++i) {
    const auto onward = followed[i];
    Duration drives_off{};
    for (const auto lane : map_.lanes_from(StationId{hops_[onward].from})) {
      const Duration begun = i == 0 ? Duration::zero() : arrives + turn(followed[i - 1], lane);
      passed_.push_back({begun, begun + hops_[lane].drive, lane, i == 0 ? lane : followed[0], true});
      if (lane == onward) drives_off = begun;
    }
    arrives = drives_off + hops_[onward].drive;
  }
  return arrives;
}

// Except for ways into dead ends beside them, all ways follow these lanes. They are therefore the ways from the end of
// these lanes, later by the time that the lanes take.
bool Timetable::follow(QuickestWays& ways) {
  const auto followed = followed_from(ways.from);
  if (followed.empty()) return false;
  const StationId end{hops_[followed.back()].to};
  auto& beyond = ways_[end.index()];
  if (beyond.arrivals.empty()) {
    beyond.from = end;
    search(beyond);
  }
  const Duration there = pass(followed);
  later_.clear();
  for (const auto lane : map_.lanes_from(end)) later_.push_back(there + turn(followed.back(), lane));
  ways.arrivals = beyond.arrivals;
  ++searches_;
  for (auto& arrival : ways.arrivals) {
    if (arrival.lane == kNone) continue;
    const Duration shift = later_[hops_[arrival.first].place];
    arrival.drives_off += shift;
    arrival.arrives += shift;
    arrival.first = followed[0];
  }
  for (const auto& arrival : passed_) ways.arrivals[hops_[arrival.lane].to] = arrival;
  ways.arrivals[ways.from.index()] = {.unique = true};
  return true;
}

// In whole nanoseconds.
void Timetable::search(QuickestWays& ways) {
  ways.arrivals.assign(map_.station_count(), {});
  ++searches_;
  open_->rewind();
  const auto hop = [&](std::uint32_t lane) { return std::pair(hops_[lane].to, hops_[lane].drive.count()); };
  search_ways(map_, ways.from, *open_, reached_, hop, [&](StationId station) {
    arrive(ways, station.value);
    return true;
  });
}

// At this point, all equally quick ways to the station are known. Times with turns are computed along the tree.
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
  arrival.unique = before.unique && reached.next_best - reached.cost > kSame.count();
}

}  // namespace fleetproof
