#include "core/agents/waiting_places.hpp"

#include <algorithm>

namespace fleetproof::agents {

WaitingPlaces::WaitingPlaces(const MapView& map, HullGeometry& geometry)
    : map_(map),
      geometry_(geometry),
      burdens_(map.station_count(), kUnknown),
      goals_(map.station_count()),
      marks_(map.station_count()),
      blocked_(map.lane_count()) {
  for (std::uint32_t id = 0; id < map.station_count(); ++id) goals_[id] = map.station(id).purposes != FP_ROUTING;
  if (std::ranges::count(goals_, true) == 0) goals_.assign(map.station_count(), true);
  goal_count_ = static_cast<std::uint32_t>(std::ranges::count(goals_, true));
}

std::uint32_t WaitingPlaces::burden(std::uint32_t station) {
  std::uint32_t& known = burdens_[station];
  if (known == kUnknown) known = work_out(station);
  return known;
}

std::uint32_t WaitingPlaces::work_out(std::uint32_t station) {
  block_lanes(station);
  const bool holds_up_followers_only = is_all_one_way(station);
  if (holds_up_followers_only && blocked_list_.empty()) return 0;
  const std::uint32_t others = goal_count_ - (goals_[station] ? 1 : 0);
  const std::uint32_t connected = mark_largest_part(station, others);
  const bool misses_lanes =
      std::ranges::any_of(blocked_list_, [&](std::uint32_t lane) { return is_missed(station, lane); });
  return (holds_up_followers_only ? 0 : others - connected) + (misses_lanes ? kFoulsLanes : 0);
}

bool WaitingPlaces::is_all_one_way(std::uint32_t station) const {
  const auto two_way = [&](std::uint32_t lane) { return map_.two_way(lane); };
  return std::ranges::none_of(map_.lanes_from(station), two_way) &&
         std::ranges::none_of(map_.lanes_to(station), two_way);
}

// The lanes that do not touch the station and are too near to it.
void WaitingPlaces::block_lanes(std::uint32_t station) {
  for (const std::uint32_t lane : blocked_list_) blocked_[lane] = false;
  blocked_list_.clear();
  for (std::uint32_t id = 0; id < map_.lane_count(); ++id) {
    const fp_lane& lane = map_.lane(id);
    if (lane.from == station || lane.to == station || !geometry_.turning_blocks_lane(station, id)) continue;
    blocked_[id] = true;
    blocked_list_.push_back(id);
  }
}

// An AGV that comes from the largest part would wait before such a lane to get back there. On a one-way lane it cannot
// turn back: it misses the lane whatever else is cut off, if an AGV that stands here blocks it. A two-way lane that
// leads into a part that is cut off anyway, as in front of a bay, is not missed.
bool WaitingPlaces::is_missed(std::uint32_t station, std::uint32_t lane) {
  if (!map_.two_way(lane) && blocks_while_waiting(station, lane)) return true;
  return (marks_[map_.lane(lane).from] & kReached) != 0 && (marks_[map_.lane(lane).to] & kReaches) != 0;
}

// An AGV that comes by one lane and leaves straight on by another one does not turn.
bool WaitingPlaces::blocks_while_waiting(std::uint32_t station, std::uint32_t lane) {
  return std::ranges::any_of(map_.lanes_to(station), [&](std::uint32_t arriving) {
    const Vec heading = map_.end_heading(arriving);
    const bool straight_on = std::ranges::any_of(map_.lanes_from(station), [&](std::uint32_t leaving) {
      return same_heading(heading, map_.start_heading(leaving));
    });
    return !straight_on || geometry_.standing_blocks_lane(station, heading, lane);
  });
}

// Marks the largest part of the map that stays connected. Every part was connected to the others by a lane that is now
// missing: it is enough to look where such lanes began and ended. Returns the number of goals in the part. Afterwards,
// the stations that the part reaches, and that reach it, are marked too.
std::uint32_t WaitingPlaces::mark_largest_part(std::uint32_t without, std::uint32_t all) {
  std::ranges::fill(marks_, std::uint8_t{0});
  std::uint32_t largest = 0;
  bool any = false;
  const auto try_from = [&](std::uint32_t station) {
    if (station == without || (any && largest == all) || marks_[station] == kInLargest) return;
    const std::uint32_t found = mark_part(station, without);
    const bool better = !any || found > largest;
    if (better) largest = found, any = true;
    for (std::uint8_t& mark : marks_) {
      const bool in_part = (mark & kInPart) == kInPart;
      const bool in_largest = better ? in_part : (mark & kInLargest) != 0;
      mark = in_largest ? std::uint8_t{kInLargest} : std::uint8_t{0};
    }
  };
  for (const std::uint32_t lane : map_.lanes_from(without)) try_from(map_.lane(lane).to);
  for (const std::uint32_t lane : map_.lanes_to(without)) try_from(map_.lane(lane).from);
  for (const std::uint32_t lane : blocked_list_) try_from(map_.lane(lane).from), try_from(map_.lane(lane).to);
  const auto inside = std::ranges::find(marks_, std::uint8_t{kInLargest});
  if (inside != marks_.end()) mark_part(static_cast<std::uint32_t>(inside - marks_.begin()), without);
  return largest;
}

// Marks the stations that `from` reaches, and that reach `from`. Returns the number of goals among them.
std::uint32_t WaitingPlaces::mark_part(std::uint32_t from, std::uint32_t without) {
  mark_reachable(from, without, false);
  mark_reachable(from, without, true);
  std::uint32_t goals = 0;
  for (std::uint32_t id = 0; id < map_.station_count(); ++id) goals += goals_[id] && (marks_[id] & kInPart) == kInPart;
  return goals;
}

void WaitingPlaces::mark_reachable(std::uint32_t from, std::uint32_t without, bool backwards) {
  const std::uint8_t mark = backwards ? kReaches : kReached;
  marks_[from] = static_cast<std::uint8_t>(marks_[from] | mark);
  stack_.assign(1, from);
  while (!stack_.empty()) {
    const std::uint32_t at = stack_.back();
    stack_.pop_back();
    for (const std::uint32_t lane : backwards ? map_.lanes_to(at) : map_.lanes_from(at)) {
      const std::uint32_t next = backwards ? map_.lane(lane).from : map_.lane(lane).to;
      if (next == without || blocked_[lane] || (marks_[next] & mark) != 0) continue;
      marks_[next] = static_cast<std::uint8_t>(marks_[next] | mark);
      stack_.push_back(next);
    }
  }
}

}  // namespace fleetproof::agents
