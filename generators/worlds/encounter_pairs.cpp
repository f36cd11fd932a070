#include "generators/worlds/encounter_pairs.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "core/base/random.hpp"
#include "core/scenario/lane_rules.hpp"
#include "generators/families/layout_builder.hpp"
#include "generators/map/timetable.hpp"
#include "generators/worlds/transports.hpp"

namespace fleetproof {
namespace {

constexpr Duration kWithin = std::chrono::seconds(1);
constexpr Duration kTie = std::chrono::milliseconds(1);
// The number of draws of the first AGV. The first draws look for the second AGV on a few places to wait. Later draws
// start both AGVs anywhere and look at more places, at all places from which AGVs may meet head-on. This is necessary
// if all places to wait are dead ends off one-way lanes.
constexpr std::uint32_t kTries = 64, kHastyTries = 3, kHastyTriesForTies = 7, kFewOthers = 8, kManyOthers = 24;
// On floors of more stations, also draws for head-on meetings look at kManyOthers: ways from all stations to all others
// take 32 bytes for each pair of stations. Larger floors need more memory and time.
constexpr std::size_t kLargeFloor = 2'000, kMostKept = kLargeFloor * kLargeFloor;

// A start for the second AGV at which the two meet. Its quickest way to `through` ends with the lane on which, or after
// which, they meet.
struct Meeting {
  StationId start, through;
  Duration earlier{};  // than the first
  bool head_on = false;

  Duration apart() const { return earlier < Duration::zero() ? -earlier : earlier; }
};

class PairMaker {
 public:
  PairMaker(Scenario& scenario, const Reachability& reachability, FleetTypes types, bool ties, RejectionCounts& counts)
      : scenario_(scenario),
        map_(*scenario.map),
        reachability_(reachability),
        counts_(counts),
        ties_(ties),
        has_rules_(has_rules(map_.layout())),
        type_(scenario.vehicle_types[0]),
        timetable_(map_, type_),
        starts_(places_to_start(map_, reachability)),
        anywhere_(reachability.starts()),
        fleet_(types),
        lanes_to_(map_.station_count(), 0) {
    for (const std::uint32_t type : types) {
      if (goals_.size() <= type) goals_.resize(type + 1);
      if (goals_[type].empty()) goals_[type] = order_ends(map_, reachability, type).picks;
    }
    for (const auto& lane : map_.lanes()) ++lanes_to_[lane.to.index()];
  }

  // Adds both AGVs, or none.
  std::optional<EncounterPair> make(Draws draws) {
    const std::size_t before = scenario_.agvs.size();
    one_ = fleet_[before], other_ = fleet_[before + 1];
    if (goals_[one_].empty() || goals_[other_].empty()) return std::nullopt;
    std::optional<Found> best;
    for (std::uint32_t i = 0; i < kTries; ++i) {
      const bool hasty = i < (ties_ ? kHastyTriesForTies : kHastyTries);
      if (ties_ && best && !hasty) break;  // the rest of the difference is removed by a later start
      const bool head_on = best && !ties_;
      const bool all = head_on && map_.station_count() <= kLargeFloor;
      const std::size_t looked_at = hasty && !ties_ ? kFewOthers : all ? anywhere_.size() : kManyOthers;
      const auto found = draw(draws, hasty ? starts_ : anywhere_, looked_at, head_on);
      if (!found || (best && !is_better(found->meeting, best->meeting))) continue;
      best = found;
      if (ties_ ? best->meeting.apart() <= kTie : best->meeting.head_on) break;
    }
    if (!best) return std::nullopt;
    const auto first = static_cast<std::uint32_t>(before);
    if (!add(best->start, best->goal, counts_) || !add(best->meeting.start, best->other_goal, counts_)) {
      scenario_.agvs.resize(before);
      return std::nullopt;
    }
    return EncounterPair{first, first + 1, best->goal, best->other_goal,
                         ties_ ? best->meeting.earlier : Duration::zero()};
  }

 private:
  struct Found {
    StationId start, goal, other_goal;
    Meeting meeting;
  };

  bool is_better(const Meeting& a, const Meeting& b) const {
    return ties_ ? a.apart() < b.apart() : a.head_on && !b.head_on;
  }

  // `head_on`: only a head-on meeting is accepted.
  std::optional<Found> draw(Draws& draws, const std::vector<StationId>& starts, std::size_t others_looked_at,
                            bool head_on) {
    const auto start = starts[draws.below(static_cast<std::uint32_t>(starts.size()))];
    const auto goal = goals_[one_][draws.below(static_cast<std::uint32_t>(goals_[one_].size()))];
    if (timetable_.kept() > kMostKept) timetable_.forget();
    const auto& ways = timetable_.from(start);
    if (start == goal || !ways.at(goal).unique || !may_go(ways, goal, one_) || !has_room(start, goal, std::nullopt))
      return std::nullopt;
    const auto way = passed_on(ways, goal);
    std::vector<StationId> others;
    others.reserve(starts.size());
    for (const auto other : starts) {
      if (other != start && (!head_on || may_come_head_on(other, way))) others.push_back(other);
    }
    if (others_looked_at < others.size()) others = some_of(draws, others, others_looked_at);
    const auto meetings = meetings_with(way, others, head_on);
    const auto order = draw_some(draws, meetings.size(), meetings.size());
    for (const auto n : ties_ ? by_time_apart(meetings, order) : head_on_first(meetings, order)) {
      const auto& meeting = meetings[n];
      const auto other_goal = goal_through(meeting, draws);
      if (other_goal && has_room(meeting.start, *other_goal, std::pair(start, goal)))
        return Found{start, goal, *other_goal, meeting};
    }
    return std::nullopt;
  }

  static std::vector<StationId> some_of(Draws& draws, const std::vector<StationId>& stations, std::size_t wanted) {
    std::vector<StationId> some;
    some.reserve(wanted);
    for (const auto n : draw_some(draws, stations.size(), wanted)) some.push_back(stations[n]);
    return some;
  }

  // In drawn order, the best kind first.
  static std::vector<std::uint32_t> by_time_apart(const std::vector<Meeting>& meetings,
                                                  std::vector<std::uint32_t> order) {
    std::ranges::stable_sort(order, {}, [&](std::uint32_t n) { return meetings[n].apart(); });
    return order;
  }
  static std::vector<std::uint32_t> head_on_first(const std::vector<Meeting>& meetings,
                                                  const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> sorted;
    sorted.reserve(order.size());
    for (const bool head_on : {true, false}) {
      for (const auto n : order) {
        if (meetings[n].head_on == head_on) sorted.push_back(n);
      }
    }
    return sorted;
  }

  // A lane on the way of the first AGV.
  struct Passed {
    StationId from, to;
    std::uint32_t lane, twin;  // twin: the same segment the other way; kNone if it is one-way
    Duration begun, ended;
  };

  std::vector<Passed> passed_on(const QuickestWays& ways, StationId goal) const {
    const auto lanes = ways.lanes(map_, goal);
    std::vector<Passed> all;
    all.reserve(lanes.size());
    for (const auto l : lanes) {
      const auto& lane = map_.lanes()[l];
      const auto* back = map_.lane(lane.segment, lane.to);
      const auto& arrival = ways.at(lane.to);
      all.push_back({lane.from, lane.to, l,
                     back == nullptr ? QuickestWays::kNone : static_cast<std::uint32_t>(back - map_.lanes().data()),
                     arrival.drives_off, arrival.arrives});
    }
    return all;
  }

  // False if simple bounds exclude a meeting. Only an AGV that starts in a dead end drives out of it. No AGV arrives
  // earlier than on a straight line.
  bool may_come_head_on(StationId other, const std::vector<Passed>& way) const {
    return std::ranges::any_of(way, [&](const Passed& passed) {
      if (passed.twin == QuickestWays::kNone) return false;
      if (other == passed.to) return passed.begun < kWithin;
      const double reach_m = type_.highest_speed_mps() * to_seconds(passed.begun + kWithin);
      const Vec2 away_m = map_.station(other).position_m - map_.station(passed.to).position_m;
      return lanes_to_[passed.to.index()] > 1 && away_m.squaredNorm() < reach_m * reach_m;
    });
  }

  // In a head-on meeting, the other AGV drives the same segment. At a station, it comes by another segment.
  std::vector<Meeting> meetings_with(const std::vector<Passed>& way, const std::vector<StationId>& starts,
                                     bool head_on) {
    std::vector<Meeting> found;
    const auto consider = [&](const Meeting& meeting) {
      if (meeting.apart() < kWithin) found.push_back(meeting);
    };
    for (const auto start : starts) {
      const auto& other = timetable_.from(start);
      for (const auto& passed : way) {
        const auto& there = other.at(passed.to);
        if (!ties_ && passed.twin != QuickestWays::kNone) {
          const auto& here = other.at(passed.from);
          if (here.lane == passed.twin && here.unique)
            consider({start, passed.from, passed.begun - here.drives_off, true});
        }
        if (!head_on && there.lane != passed.lane && there.lane != QuickestWays::kNone && there.unique) {
          consider({start, passed.to, passed.ended - there.arrives, false});
        }
      }
    }
    return found;
  }

  // Draws one of the goals to which the quickest way from the start leads through the meeting, or ends there.
  std::optional<StationId> goal_through(const Meeting& meeting, Draws& draws) {
    const auto& ways = timetable_.from(meeting.start);
    const Duration met = ways.at(meeting.through).arrives;
    std::vector<StationId> through;
    through.reserve(goals_[other_].size());
    for (const auto goal : goals_[other_]) {
      if (goal == meeting.start || !ways.at(goal).unique || !may_go(ways, goal, other_)) continue;
      StationId s = goal;
      while (ways.at(s).arrives > met) s = map_.lanes()[ways.at(s).lane].from;
      if (s == meeting.through) through.push_back(goal);
    }
    if (through.empty()) return std::nullopt;
    return through[draws.below(static_cast<std::uint32_t>(through.size()))];
  }

  // Whether the plant permits the quickest way to an empty AGV of this type, from its start on. The timetable knows no
  // rules.
  bool may_go(const QuickestWays& ways, StationId goal, std::uint32_t type) const {
    if (!has_rules_) return true;
    const auto lanes = ways.lanes(map_, goal);
    return !lanes.empty() && reachability_.may_start_along(lanes.front(), type) &&
           std::ranges::all_of(lanes, [&](std::uint32_t lane) { return reachability_.permits(lane, false, type); });
  }

  Vec2 heading(StationId start, StationId goal) {
    return map_.lanes()[timetable_.from(start).at(goal).first].start_heading();
  }

  bool add(StationId start, StationId goal, RejectionCounts& counts) {
    return add_agv(scenario_, start, heading(start, goal), counts);
  }

  // Whether an AGV finds room, together with the first AGV of its pair if that is given. The fleet is
  // unchanged afterwards.
  bool has_room(StationId start, StationId goal, std::optional<std::pair<StationId, StationId>> after) {
    const std::size_t before = scenario_.agvs.size();
    RejectionCounts tried;
    const bool room = (!after || add(after->first, after->second, tried)) && add(start, goal, tried);
    scenario_.agvs.resize(before);
    return room;
  }

  Scenario& scenario_;
  const LogicalMap& map_;
  const Reachability& reachability_;
  RejectionCounts& counts_;
  bool ties_, has_rules_;
  const VehicleType& type_;
  Timetable timetable_;
  std::vector<StationId> starts_, anywhere_;
  FleetTypes fleet_;
  std::vector<std::vector<StationId>> goals_;  // by type
  std::uint32_t one_ = 0, other_ = 0;          // the types of the pair that is being made
  std::vector<std::uint32_t> lanes_to_;        // how many, by station
};

}  // namespace

std::vector<EncounterPair> place_pairs(Scenario& scenario, FleetTypes types, Placement placement,
                                       const Reachability& reachability, std::uint64_t key, std::uint32_t attempt,
                                       RejectionCounts& counts) {
  std::vector<EncounterPair> pairs;
  if (reachability.starts().size() < 2) return pairs;
  PairMaker maker(scenario, reachability, types, placement == Placement::Symmetric, counts);
  while (scenario.agvs.size() + 2 <= types.size()) {
    ++counts.pairs_wanted;
    const auto pair = maker.make(Draws(key, attempt, static_cast<std::uint32_t>(scenario.agvs.size())));
    if (!pair) break;
    pairs.push_back(*pair);
    ++counts.pairs_made;
  }
  return pairs;
}

void send_to_meet(Scenario& scenario, const std::vector<EncounterPair>& pairs, const std::vector<OrderEnds>& ends) {
  const auto begin_at = [&](AgvSetup& agv, StationId goal) {
    TransportOrder& order = agv.transports[0];
    const auto& picks = ends[agv.type].picks;
    const auto pick = std::ranges::lower_bound(picks, goal) - picks.begin();
    const auto& drops = ends[agv.type].drops_from(static_cast<std::size_t>(pick));
    const auto may_end = [&](StationId s) { return s != goal && std::ranges::binary_search(drops, s); };
    if (!may_end(order.to)) order.to = may_end(order.from) ? order.from : drops[drops[0] == goal ? 1 : 0];
    order.from = goal;
  };
  const auto release = [](std::vector<TransportOrder>& orders, Duration at) {
    orders[0].release = at;
    for (std::size_t i = 1; i < orders.size() && orders[i].release < at; ++i) orders[i].release = at;
  };
  for (const auto& pair : pairs) {
    auto& first = scenario.agvs[pair.first].transports;
    auto& second = scenario.agvs[pair.second].transports;
    if (first.empty() || second.empty()) continue;
    const Duration earlier = std::min(first[0].release, second[0].release);
    const Duration later = std::min(
        earlier + (pair.second_after < Duration::zero() ? -pair.second_after : pair.second_after), scenario.horizon);
    release(first, pair.second_after < Duration::zero() ? later : earlier);
    release(second, pair.second_after > Duration::zero() ? later : earlier);
    begin_at(scenario.agvs[pair.first], pair.first_goal);
    begin_at(scenario.agvs[pair.second], pair.second_goal);
  }
}

}  // namespace fleetproof
