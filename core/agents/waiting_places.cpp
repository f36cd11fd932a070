#include "core/agents/waiting_places.hpp"

#include <algorithm>

namespace fleetproof::agents {

WaitingPlaces::WaitingPlaces(const MapView& map, HullGeometry& geometry)
    : map_(map),
      geometry_(geometry),
      burdens_(map.station_count(), kUnknown),
      goals_(map.station_count()),
      without_(map),
      marks_(map.station_count()),
      cut_off_(map.station_count(), 0) {
  for (std::uint32_t id = 0; id < map.station_count(); ++id) goals_[id] = map.station(id).purposes != FP_ROUTING;
  if (std::ranges::count(goals_, true) == 0) goals_.assign(map.station_count(), true);
  goal_count_ = static_cast<std::uint32_t>(std::ranges::count(goals_, true));
  const auto first = static_cast<std::uint32_t>(std::ranges::find(goals_, true) - goals_.begin());
  goals_are_connected_ = goal_count_ > 1 && mark_part(first) == goal_count_;
  if (goals_are_connected_) free_marks_ = marks_;
}

std::uint32_t WaitingPlaces::burden(std::uint32_t station) {
  std::uint32_t& known = burdens_[station];
  if (known == kUnknown) known = work_out(station);
  return known;
}

std::uint32_t WaitingPlaces::work_out(std::uint32_t station) {
  block_lanes(station);
  const bool holds_up_followers_only = is_all_one_way(station);
  if (holds_up_followers_only && without_.blocked().empty()) return 0;
  const std::uint32_t others = goal_count_ - (goals_[station] ? 1 : 0);
  const bool only_pieces = goals_are_connected_ && cuts_off_pieces_only(station, others);
  const std::uint32_t cut_off = only_pieces ? goals_in_pieces_ : others - mark_largest_part(station, others);
  const bool misses_lanes = std::ranges::any_of(
      without_.blocked(), [&](std::uint32_t lane) { return is_missed(station, lane, only_pieces); });
  return (holds_up_followers_only ? 0 : cut_off) + (misses_lanes ? kFoulsLanes : 0);
}

// True if it is easily seen what the station cuts off: small pieces, such as bays, that no lane connects with the rest,
// while every other way through the station and every other blocked lane has a way round. Then the rest of the map
// reaches all that it reached before. False says nothing.
bool WaitingPlaces::cuts_off_pieces_only(std::uint32_t station, std::uint32_t others) {
  ++judged_;
  goals_in_pieces_ = 0;
  std::uint32_t largest = 0;
  const auto is_no_riddle = [&](std::uint32_t from) {
    if (from == station || is_cut_off(from) || !without_.explore(from, false, kSmallPiece)) return true;
    const std::vector<std::uint32_t> piece(without_.found().begin(), without_.found().end());
    if (!without_.explore(from, true, kSmallPiece) || without_.found().size() != piece.size()) return false;
    std::uint32_t goals = 0;
    for (const std::uint32_t id : piece) {
      if (!without_.was_found(id)) return false;
      cut_off_[id] = judged_;
      goals += goals_[id] ? 1U : 0U;
    }
    goals_in_pieces_ += goals;
    largest = std::max(largest, goals);
    return true;
  };
  const auto ends = [&](std::uint32_t lane) {
    return is_no_riddle(map_.lane(lane).from) && is_no_riddle(map_.lane(lane).to);
  };
  return std::ranges::all_of(map_.lanes_from(station), ends) && std::ranges::all_of(map_.lanes_to(station), ends) &&
         std::ranges::all_of(without_.blocked(), ends) && others - goals_in_pieces_ > largest && has_detours(station);
}

bool WaitingPlaces::has_detours(std::uint32_t station) {
  const auto has_detour = [&](std::uint32_t from, std::uint32_t to) {
    return from == to || from == station || to == station || is_cut_off(from) || is_cut_off(to) ||
           without_.reaches(from, to);
  };
  for (const std::uint32_t arriving : map_.lanes_to(station)) {
    for (const std::uint32_t leaving : map_.lanes_from(station)) {
      if (!has_detour(map_.lane(arriving).from, map_.lane(leaving).to)) return false;
    }
  }
  return std::ranges::all_of(without_.blocked(),
                             [&](std::uint32_t lane) { return has_detour(map_.lane(lane).from, map_.lane(lane).to); });
}

bool WaitingPlaces::is_all_one_way(std::uint32_t station) const {
  const auto two_way = [&](std::uint32_t lane) { return map_.two_way(lane); };
  return std::ranges::none_of(map_.lanes_from(station), two_way) &&
         std::ranges::none_of(map_.lanes_to(station), two_way);
}

// The lanes that do not touch the station and are too near to it.
void WaitingPlaces::block_lanes(std::uint32_t station) {
  without_.take_away(station);
  for (const std::uint32_t id : geometry_.lanes_near(station)) {
    const fp_lane& lane = map_.lane(id);
    if (lane.from == station || lane.to == station || !geometry_.turning_blocks_lane(station, id)) continue;
    without_.block(id);
  }
}

// An AGV that comes from the largest part would wait before such a lane to get back there. On a one-way lane it cannot
// turn back: it misses the lane whatever else is cut off, if an AGV that stands here blocks it. A two-way lane that
// leads into a part that is cut off anyway, as in front of a bay, is not missed.
bool WaitingPlaces::is_missed(std::uint32_t station, std::uint32_t lane, bool only_pieces) {
  if (!map_.two_way(lane) && blocks_while_waiting(station, lane)) return true;
  const std::uint32_t from = map_.lane(lane).from, to = map_.lane(lane).to;
  if (only_pieces && (is_cut_off(from) || is_cut_off(to))) return false;
  const std::vector<std::uint8_t>& marks = only_pieces ? free_marks_ : marks_;
  return (marks[from] & kReached) != 0 && (marks[to] & kReaches) != 0;
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
    const std::uint32_t found = mark_part(station);
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
  for (const std::uint32_t lane : without_.blocked()) try_from(map_.lane(lane).from), try_from(map_.lane(lane).to);
  const auto inside = std::ranges::find(marks_, std::uint8_t{kInLargest});
  if (inside != marks_.end()) mark_part(static_cast<std::uint32_t>(inside - marks_.begin()));
  return largest;
}

// Marks the stations that `from` reaches, and that reach `from`. Returns the number of goals among them.
std::uint32_t WaitingPlaces::mark_part(std::uint32_t from) {
  for (const bool backwards : {false, true}) {
    without_.explore(from, backwards);
    for (const std::uint32_t id : without_.found())
      marks_[id] = static_cast<std::uint8_t>(marks_[id] | (backwards ? kReaches : kReached));
  }
  std::uint32_t goals = 0;
  for (std::uint32_t id = 0; id < map_.station_count(); ++id) goals += goals_[id] && (marks_[id] & kInPart) == kInPart;
  return goals;
}

}  // namespace fleetproof::agents
