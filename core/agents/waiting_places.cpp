#include "core/agents/waiting_places.hpp"

#include <algorithm>

#include "core/agents/facts.hpp"

namespace fleetproof::agents {

MapWithout::MapWithout(const MapView& map) : blocked_(map.lane_count(), false), seen_(map.station_count(), 0) {
  std::span<const std::byte> bytes;
  if (map.facts() == nullptr) {
    own_ = work_out(map);
    bytes = own_;
  } else {
    bytes = ask<std::byte>(
        *map.facts(),
        [](const fp_facts* from, std::uint64_t, fp_answer* to) { answer(*from, to, work_out(MapView(*from))); }, 0);
  }
  TableReader tables(bytes);
  for (Hops* const hops : {&onward_, &back_}) {
    hops->all = tables.next<Hop>();
    hops->first = tables.next<std::uint32_t>();
  }
}

std::vector<std::byte> MapWithout::work_out(const MapView& map) {
  TableWriter tables;
  for (const bool back : {false, true}) {
    std::vector<Hop> hops;
    std::vector<std::uint32_t> first;
    hops.reserve(map.lane_count()), first.reserve(map.station_count() + 1);
    for (std::uint32_t station = 0; station < map.station_count(); ++station) {
      first.push_back(static_cast<std::uint32_t>(hops.size()));
      for (const std::uint32_t lane : back ? map.lanes_to(station) : map.lanes_from(station))
        hops.push_back({lane, back ? map.lane(lane).from : map.lane(lane).to});
    }
    first.push_back(static_cast<std::uint32_t>(hops.size()));
    tables.add(hops), tables.add(first);
  }
  return tables.bytes();
}

void MapWithout::take_away(std::uint32_t station) {
  without_ = station;
  for (const std::uint32_t lane : blocked_list_) blocked_[lane] = false;
  blocked_list_.clear();
}

void MapWithout::block(std::uint32_t lane) {
  blocked_[lane] = true;
  blocked_list_.push_back(lane);
}

void MapWithout::begin_look(std::uint32_t from) {
  seen_[from] = ++look_;
  found_.assign(1, from);
}

void MapWithout::look_on(std::uint32_t at, bool backwards) {
  const Hops& hops = backwards ? back_ : onward_;
  for (std::uint32_t hop = hops.first[at]; hop < hops.first[at + 1]; ++hop) {
    const auto [lane, next] = hops.all[hop];
    if (next == without_ || was_found(next) || blocked_[lane]) continue;
    seen_[next] = look_;
    found_.push_back(next);
  }
}

namespace {

constexpr std::size_t kRoots = 4;
// So many stations are judged at once: what a judge needs for any of them costs as much as a few judgements.
constexpr std::uint32_t kTogether = 16;

enum Mark : std::uint8_t { kReached = 1, kReaches = 2, kInPart = 3 };

// Marks the stations that `from` reaches, which were just found, and those that reach `from`. Returns the number of
// goals that are both.
std::uint32_t mark_part(MapWithout& map, std::uint32_t from, std::span<const std::uint8_t> is_goal,
                        std::vector<std::uint8_t>& marks) {
  for (const std::uint32_t id : map.found()) marks[id] = kReached;
  map.explore(from, true);
  std::uint32_t goals = 0;
  for (const std::uint32_t id : map.found()) {
    goals += is_goal[id] != 0 && marks[id] == kReached;
    marks[id] = static_cast<std::uint8_t>(marks[id] | kReaches);
  }
  return goals;
}

std::vector<std::byte> work_out_goals(const MapView& map) {
  std::vector<std::uint8_t> is_goal(map.station_count()), marks(map.station_count());
  for (std::uint32_t id = 0; id < map.station_count(); ++id) is_goal[id] = map.station(id).purposes != FP_ROUTING;
  if (std::ranges::count(is_goal, 1) == 0) is_goal.assign(map.station_count(), 1);
  const auto count = static_cast<std::uint32_t>(std::ranges::count(is_goal, 1));
  const auto first = static_cast<std::uint32_t>(std::ranges::find(is_goal, 1) - is_goal.begin());
  MapWithout whole(map);
  whole.explore(first, false);
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

// From and to goals that are far apart: their numbers are.
std::span<const std::byte> sure_ways(const fp_facts& facts) {
  return ask<std::byte>(
      facts,
      [](const fp_facts* from, std::uint64_t, fp_answer* to) {
        const MapView map(*from);
        const Goals goals = goals_of(*from);
        std::vector<std::uint32_t> all, roots;
        for (std::uint32_t id = 0; id < map.station_count(); ++id) {
          if (goals.is_goal[id] != 0) all.push_back(id);
        }
        const std::size_t count = std::min(kRoots, all.size());
        for (std::size_t i = 0; i < count; ++i) roots.push_back(all[(2 * i + 1) * all.size() / (2 * count)]);
        answer(*from, to, SureWays::work_out(map, roots));
      },
      0);
}

}  // namespace

PlaceJudge::PlaceJudge(const MapView& map, const HullParts& parts)
    : map_(map),
      parts_(parts),
      goals_(goals_of(parts.facts())),
      without_(map),
      sure_(map, sure_ways(parts.facts())),
      sides_(map.station_count()) {}

std::uint32_t burden_of(const HullParts& parts, std::uint32_t station) {
  return ask<std::uint32_t>(
      parts.facts(),
      [](const fp_facts* facts, std::uint64_t question, fp_answer* to) {
        const MapView map(*facts);
        const HullParts of(map, *facts, HullKey(question));
        PlaceJudge judge(map, of);
        const std::uint32_t first = HullKey::item_of(question) * kTogether;
        std::vector<std::uint32_t> burdens;
        for (std::uint32_t id = first; id < std::min(first + kTogether, map.station_count()); ++id)
          burdens.push_back(judge.burden(id));
        answer(*facts, to, burdens);
      },
      parts.key().question(station / kTogether))[station % kTogether];
}

std::uint32_t PlaceJudge::burden(std::uint32_t station) {
  block_lanes(station);
  const auto blocked = without_.blocked();
  const bool holds_up_followers_only = is_all_one_way(station);
  const auto two_way = [&](std::uint32_t lane) { return map_.two_way(lane); };
  // Then nothing depends on what is cut off.
  if (holds_up_followers_only && std::ranges::none_of(blocked, two_way))
    return misses_any(station, blocked, false) ? kFoulsLanes : 0;
  const std::uint32_t others = goals_.count - (goals_.is_goal[station] != 0 ? 1 : 0);
  if (goals_.are_connected) sure_.take_away(station, blocked);
  const bool only_pieces = goals_.are_connected && cuts_off_pieces_only(station, others);
  const std::uint32_t cut_off = only_pieces ? goals_in_pieces_ : others - find_largest_part(station, others);
  return (holds_up_followers_only ? 0 : cut_off) + (misses_any(station, blocked, only_pieces) ? kFoulsLanes : 0);
}

bool PlaceJudge::misses_any(std::uint32_t station, std::span<const std::uint32_t> lanes, bool only_pieces) {
  return std::ranges::any_of(lanes, [&](std::uint32_t lane) { return is_missed(station, lane, only_pieces); });
}

// True if it is easily seen what the station cuts off: pieces that reach the roots of the sure ways no more, or are not
// reached from there, such as bays and the lanes that only lead to them. The rest stays connected, and is the largest
// part. Every way that is broken left it at a station beside what is missing or cut off, or comes back at one, so the
// pieces contain all that is cut off. False says nothing about the burden.
bool PlaceJudge::cuts_off_pieces_only(std::uint32_t station, std::uint32_t others) {
  for (const std::uint32_t id : seen_) sides_[id] = 0;
  for (const std::uint32_t id : pieces_) sides_[id] = 0;
  seen_.clear(), pieces_.clear();
  goals_in_pieces_ = 0;
  const auto visit = [&](std::uint32_t end) {
    if (end != station) cut_off_around(end);
  };
  for (const std::uint32_t lane : map_.lanes_to(station)) visit(map_.lane(lane).from);
  for (const std::uint32_t lane : map_.lanes_from(station)) visit(map_.lane(lane).to);
  for (const std::uint32_t lane : without_.blocked()) visit(map_.lane(lane).from), visit(map_.lane(lane).to);
  for (std::size_t next = 0; next < pieces_.size(); ++next) {
    for (const std::uint32_t lane : map_.lanes_to(pieces_[next])) visit(map_.lane(lane).from);
    for (const std::uint32_t lane : map_.lanes_from(pieces_[next])) visit(map_.lane(lane).to);
  }
  return others - goals_in_pieces_ > goals_in_pieces_;
}

// Looks at a station beside what is missing or cut off, and marks the pieces there.
void PlaceJudge::cut_off_around(std::uint32_t end) {
  if ((sides_[end] & kSeen) != 0) return;
  sides_[end] |= kSeen;
  seen_.push_back(end);
  for (const bool backwards : {false, true}) {
    const Side side = backwards ? kUnreached : kDoomed;
    const Side connected = backwards ? kStillReached : kStillReaches;
    if ((sides_[end] & side) != 0) continue;  // what lies beyond it is, too
    const auto look = [&](std::uint32_t id) {
      if ((sides_[id] & side) != 0) return MapWithout::Look::NotBeyond;
      const bool is_connected = (sides_[id] & connected) != 0 || sure_.is_sure(id, backwards);
      return is_connected ? MapWithout::Look::Stop : MapWithout::Look::On;
    };
    if (!without_.explore(end, backwards, look)) {
      sides_[end] = static_cast<std::uint8_t>(sides_[end] | connected);
      continue;
    }
    for (const std::uint32_t id : without_.found()) {
      if ((sides_[id] & kCutOff) == 0) {
        pieces_.push_back(id);
        goals_in_pieces_ += goals_.is_goal[id];
      }
      sides_[id] = static_cast<std::uint8_t>(sides_[id] | side);
    }
  }
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

// An AGV that comes from the largest part would wait before such a lane to get back there. A two-way lane that leads
// into a part that is cut off anyway, as in front of a bay, is not missed. Before a one-way lane, AGVs wait until the
// way is free again, as behind this AGV. But those that are about to go on the other way could block its own way on,
// and none of them can turn back.
bool PlaceJudge::is_missed(std::uint32_t station, std::uint32_t lane, bool only_pieces) {
  if (!map_.two_way(lane)) return leads_against(station, lane) && blocks_while_waiting(station, lane);
  const std::uint32_t from = map_.lane(lane).from, to = map_.lane(lane).to;
  if (only_pieces && ((sides_[from] & kUnreached) != 0 || (sides_[to] & kDoomed) != 0)) return false;
  if (only_pieces) return (goals_.free_marks[from] & kReached) != 0 && (goals_.free_marks[to] & kReaches) != 0;
  return part_ != FP_NONE && reaches(part_, from) && reaches(to, part_);
}

// Whether an AGV on the lane goes on the other way than one that arrives at the station.
bool PlaceJudge::leads_against(std::uint32_t station, std::uint32_t lane) const {
  return std::ranges::any_of(map_.lanes_to(station), [&](std::uint32_t arriving) {
    return opposite_heading(map_.end_heading(lane), map_.end_heading(arriving));
  });
}

// An AGV that comes by one lane and leaves straight on by another one does not turn.
bool PlaceJudge::blocks_while_waiting(std::uint32_t station, std::uint32_t lane) const {
  return std::ranges::any_of(map_.lanes_to(station), [&](std::uint32_t arriving) {
    const Vec heading = map_.end_heading(arriving);
    const bool straight_on = std::ranges::any_of(map_.lanes_from(station), [&](std::uint32_t leaving) {
      return same_heading(heading, map_.start_heading(leaving));
    });
    return !straight_on || parts_.standing_blocks_lane(station, heading, lane);
  });
}

// Looks for the largest part of the map that stays connected, where lanes that are missing now began and ended.
// Returns the number of goals in the part.
std::uint32_t PlaceJudge::find_largest_part(std::uint32_t without, std::uint32_t others) {
  std::uint32_t largest = 0;
  part_ = FP_NONE;
  const auto try_from = [&](std::uint32_t station) {
    const bool is_certain = part_ != FP_NONE && 2 * largest >= others;  // no part of the rest is larger
    if (station == without || is_certain) return;
    const std::uint32_t goals = goals_connected_with(station, others);
    if (part_ != FP_NONE && goals <= largest) return;
    largest = goals;
    part_ = station;
  };
  for (const std::uint32_t lane : map_.lanes_from(without)) try_from(map_.lane(lane).to);
  for (const std::uint32_t lane : map_.lanes_to(without)) try_from(map_.lane(lane).from);
  for (const std::uint32_t lane : without_.blocked()) try_from(map_.lane(lane).from), try_from(map_.lane(lane).to);
  return largest;
}

// How many goals the station reaches that also reach it. Either few stations are reached from it, or few reach it, or
// it is connected with the roots of the sure ways.
std::uint32_t PlaceJudge::goals_connected_with(std::uint32_t station, std::uint32_t others) {
  is_inside_.resize(map_.station_count());
  for (const bool backwards : {false, true}) {
    const auto look = [&](std::uint32_t id) {
      return sure_.is_sure(id, backwards) ? MapWithout::Look::Stop : MapWithout::Look::On;
    };
    if (!without_.explore(station, backwards, look)) continue;
    const std::vector<std::uint32_t> inside(without_.found().begin(), without_.found().end());
    for (const std::uint32_t id : inside) is_inside_[id] = 1;
    without_.explore(station, !backwards, [&](std::uint32_t id) {
      return is_inside_[id] != 0 ? MapWithout::Look::On : MapWithout::Look::NotBeyond;
    });
    std::uint32_t goals = 0;
    for (const std::uint32_t id : without_.found()) goals += goals_.is_goal[id] != 0 && is_inside_[id] != 0;
    for (const std::uint32_t id : inside) is_inside_[id] = 0;
    return goals;
  }
  return others - goals_in_pieces_;
}

bool PlaceJudge::reaches(std::uint32_t from, std::uint32_t to) {
  bool found = false;
  const auto look_for = [&](std::uint32_t station, bool backwards) {
    return [this, station, backwards, &found](std::uint32_t id) {
      found = found || id == station;
      return found || sure_.is_sure(id, backwards) ? MapWithout::Look::Stop : MapWithout::Look::On;
    };
  };
  if (without_.explore(from, false, look_for(to, false))) return false;
  return found || !without_.explore(to, true, look_for(from, true));
}

}  // namespace fleetproof::agents
