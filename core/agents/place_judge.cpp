#include "core/agents/place_judge.hpp"

#include <algorithm>

#include "core/agents/facts.hpp"

namespace fleetproof::agents {

namespace {

enum Mark : std::uint8_t { kReached = 1, kReaches = 2, kInPart = 3, kInLargest = 4 };

// Marks the stations that `from` reaches, and that reach `from`. Returns the number of goals among them.
std::uint32_t mark_part(MapWithout& map, std::uint32_t from, std::span<const std::uint8_t> is_goal,
                        std::vector<std::uint8_t>& marks) {
  for (const bool backwards : {false, true}) {
    map.explore(from, backwards);
    for (const std::uint32_t id : map.found())
      marks[id] = static_cast<std::uint8_t>(marks[id] | (backwards ? kReaches : kReached));
  }
  std::uint32_t goals = 0;
  for (std::uint32_t id = 0; id < marks.size(); ++id) goals += is_goal[id] != 0 && (marks[id] & kInPart) == kInPart;
  return goals;
}

std::vector<std::byte> work_out_goals(const MapView& map) {
  std::vector<std::uint8_t> is_goal(map.station_count()), marks(map.station_count());
  for (std::uint32_t id = 0; id < map.station_count(); ++id) is_goal[id] = map.station(id).purposes != FP_ROUTING;
  if (std::ranges::count(is_goal, 1) == 0) is_goal.assign(map.station_count(), 1);
  const auto count = static_cast<std::uint32_t>(std::ranges::count(is_goal, 1));
  const auto first = static_cast<std::uint32_t>(std::ranges::find(is_goal, 1) - is_goal.begin());
  MapWithout whole(map);
  const bool are_connected = count > 1 && mark_part(whole, first, is_goal, marks) == count;
  TableWriter tables;
  tables.add(is_goal), tables.add(marks), tables.add(std::vector<std::uint32_t>{count, are_connected ? 1U : 0U});
  return tables.bytes();
}

Goals goals_of(const fp_facts& facts) {
  TableReader tables(ask<std::byte>(
      facts,
      [](const fp_facts* from, std::uint64_t, fp_answer* to) { answer(*from, to, work_out_goals(MapView(*from))); },
      0));
  Goals goals{tables.next<std::uint8_t>(), tables.next<std::uint8_t>()};
  const auto counts = tables.next<std::uint32_t>();
  goals.count = counts[0];
  goals.are_connected = counts[1] != 0;
  return goals;
}

}  // namespace

PlaceJudge::PlaceJudge(const MapView& map, const HullParts& parts)
    : map_(map), parts_(parts), goals_(goals_of(parts.facts())), without_(map), marks_(map.station_count()) {}

std::uint32_t burden_of(const HullParts& parts, std::uint32_t station) {
  return ask<std::uint32_t>(
             parts.facts(),
             [](const fp_facts* facts, std::uint64_t question, fp_answer* to) {
               const MapView map(*facts);
               const HullParts of(map, *facts, HullKey(question));
               answer(*facts, to, std::vector{PlaceJudge(map, of).burden(HullKey::item_of(question))});
             },
             parts.key().question(station))
      .front();
}

std::uint32_t PlaceJudge::burden(std::uint32_t station) {
  block_lanes(station);
  const bool holds_up_followers_only = is_all_one_way(station);
  if (holds_up_followers_only && without_.blocked().empty()) return 0;
  const std::uint32_t others = goals_.count - (goals_.is_goal[station] != 0 ? 1 : 0);
  const bool only_pieces = goals_.are_connected && cuts_off_pieces_only(station, others);
  const std::uint32_t cut_off = only_pieces ? goals_in_pieces_ : others - mark_largest_part(station, others);
  const bool misses_lanes = std::ranges::any_of(
      without_.blocked(), [&](std::uint32_t lane) { return is_missed(station, lane, only_pieces); });
  return (holds_up_followers_only ? 0 : cut_off) + (misses_lanes ? kFoulsLanes : 0);
}

// True if it is easily seen what the station cuts off: small pieces, such as bays, that no lane connects with the rest,
// while every other way through the station and every other blocked lane has a way round. Then the rest of the map
// reaches all that it reached before. False says nothing.
bool PlaceJudge::cuts_off_pieces_only(std::uint32_t station, std::uint32_t others) {
  cut_off_.assign(map_.station_count(), false);
  goals_in_pieces_ = 0;
  std::uint32_t largest = 0;
  const auto is_no_riddle = [&](std::uint32_t from) {
    if (from == station || is_cut_off(from) || !without_.explore(from, false, kSmallPiece)) return true;
    const std::vector<std::uint32_t> piece(without_.found().begin(), without_.found().end());
    if (!without_.explore(from, true, kSmallPiece) || without_.found().size() != piece.size()) return false;
    std::uint32_t goals = 0;
    for (const std::uint32_t id : piece) {
      if (!without_.was_found(id)) return false;
      cut_off_[id] = true;
      goals += goals_.is_goal[id];
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

bool PlaceJudge::has_detours(std::uint32_t station) {
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

bool PlaceJudge::is_all_one_way(std::uint32_t station) const {
  const auto two_way = [&](std::uint32_t lane) { return map_.two_way(lane); };
  return std::ranges::none_of(map_.lanes_from(station), two_way) &&
         std::ranges::none_of(map_.lanes_to(station), two_way);
}

// The lanes that do not touch the station and are too near to it.
void PlaceJudge::block_lanes(std::uint32_t station) {
  without_.take_away(station);
  for (const std::uint32_t id : parts_.lanes_blocked_by_turning(station)) {
    if (map_.lane(id).from != station && map_.lane(id).to != station) without_.block(id);
  }
}

// An AGV that comes from the largest part would wait before such a lane to get back there. On a one-way lane it cannot
// turn back: it misses the lane whatever else is cut off, if an AGV that stands here blocks it. A two-way lane that
// leads into a part that is cut off anyway, as in front of a bay, is not missed.
bool PlaceJudge::is_missed(std::uint32_t station, std::uint32_t lane, bool only_pieces) {
  if (!map_.two_way(lane) && blocks_while_waiting(station, lane)) return true;
  const std::uint32_t from = map_.lane(lane).from, to = map_.lane(lane).to;
  if (only_pieces && (is_cut_off(from) || is_cut_off(to))) return false;
  const std::span<const std::uint8_t> marks = only_pieces ? goals_.free_marks : std::span<const std::uint8_t>(marks_);
  return (marks[from] & kReached) != 0 && (marks[to] & kReaches) != 0;
}

// An AGV that comes by one lane and leaves straight on by another one does not turn.
bool PlaceJudge::blocks_while_waiting(std::uint32_t station, std::uint32_t lane) {
  return std::ranges::any_of(map_.lanes_to(station), [&](std::uint32_t arriving) {
    const Vec heading = map_.end_heading(arriving);
    const bool straight_on = std::ranges::any_of(map_.lanes_from(station), [&](std::uint32_t leaving) {
      return same_heading(heading, map_.start_heading(leaving));
    });
    return !straight_on || parts_.standing_blocks_lane(station, heading, lane);
  });
}

// Marks the largest part of the map that stays connected. Every part was connected to the others by a lane that is now
// missing: it is enough to look where such lanes began and ended. Returns the number of goals in the part. Afterwards,
// the stations that the part reaches, and that reach it, are marked too.
std::uint32_t PlaceJudge::mark_largest_part(std::uint32_t without, std::uint32_t all) {
  std::ranges::fill(marks_, std::uint8_t{0});
  std::uint32_t largest = 0;
  bool any = false;
  const auto try_from = [&](std::uint32_t station) {
    if (station == without || (any && largest == all) || marks_[station] == kInLargest) return;
    const std::uint32_t found = mark_part(without_, station, goals_.is_goal, marks_);
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
  if (inside != marks_.end())
    mark_part(without_, static_cast<std::uint32_t>(inside - marks_.begin()), goals_.is_goal, marks_);
  return largest;
}

}  // namespace fleetproof::agents
