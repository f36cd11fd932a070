#include "generators/encounter_pairs.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "core/random.hpp"
#include "generators/layout_builder.hpp"
#include "generators/timetable.hpp"
#include "generators/transports.hpp"

namespace fleetproof {
namespace {

constexpr Duration kWithin = std::chrono::seconds(1);
constexpr Duration kTie = std::chrono::milliseconds(1);
constexpr std::uint32_t kTries = 16;  // drawings of the first AGV
// Starts of the second one that are looked at in each of the first tries; later, and for ties, all are.
constexpr std::uint32_t kFewOthers = 10, kHastyTries = 3;

// Where the second AGV may start so that the two meet: its quickest way to `through` ends with the lane on which, or after which, they do.
struct Meeting {
  StationId start, through;
  Duration apart{};
  bool head_on = false;
};

class PairMaker {
 public:
  PairMaker(Scenario& scenario, const Reachability& reachability, bool ties, RejectionCounts& counts)
      : scenario_(scenario),
        map_(*scenario.map),
        counts_(counts),
        ties_(ties),
        timetable_(map_, scenario.vehicle_types[0]),
        starts_(places_to_start(map_, reachability)),
        core_(reachability.core()),
        goals_(order_ends(map_, reachability)) {}

  // Adds both AGVs, or none.
  std::optional<EncounterPair> make(Draws draws) {
    const std::size_t before = scenario_.agvs.size();
    std::optional<Found> best;
    for (std::uint32_t i = 0; i < kTries; ++i) {
      // Where places to wait are few, or lie so that nobody meets, any station serves.
      const auto found = draw(draws, i < kTries / 2 ? starts_ : core_, i < kHastyTries && !ties_ ? kFewOthers : core_.size());
      if (!found || (best && !is_better(found->meeting, best->meeting))) continue;
      best = found;
      if (ties_ ? best->meeting.apart <= kTie : best->meeting.head_on) break;
    }
    if (!best) return std::nullopt;
    const auto first = static_cast<std::uint32_t>(before);
    if (!add(best->start, best->goal, counts_) || !add(best->meeting.start, best->other_goal, counts_)) {
      scenario_.agvs.resize(before);
      return std::nullopt;
    }
    return EncounterPair{first, first + 1, best->goal, best->other_goal};
  }

 private:
  struct Found {
    StationId start, goal, other_goal;
    Meeting meeting;
  };

  bool is_better(const Meeting& a, const Meeting& b) const { return ties_ ? a.apart < b.apart : a.head_on && !b.head_on; }

  std::optional<Found> draw(Draws& draws, const std::vector<StationId>& starts, std::size_t others_looked_at) {
    const auto start = starts[draws.below(static_cast<std::uint32_t>(starts.size()))];
    const auto goal = goals_[draws.below(static_cast<std::uint32_t>(goals_.size()))];
    const auto& ways = timetable_.from(start);
    if (start == goal || ways.unique[goal.index()] == 0 || !has_room(start, goal, std::nullopt)) return std::nullopt;
    std::vector<StationId> others;
    for (const auto n : draw_some(draws, starts.size(), others_looked_at)) others.push_back(starts[n]);
    const auto meetings = meetings_with(ways, goal, others);
    // In drawn order, the best kind first.
    std::vector<Meeting> in_order;
    for (const auto n : draw_some(draws, meetings.size(), meetings.size())) in_order.push_back(meetings[n]);
    if (ties_) {
      std::ranges::stable_sort(in_order, {}, &Meeting::apart);
    } else {
      std::ranges::stable_sort(in_order, {}, [](const Meeting& m) { return !m.head_on; });
    }
    for (const auto& meeting : in_order) {
      const auto other_goal = goal_through(meeting, draws);
      if (other_goal && has_room(meeting.start, *other_goal, std::pair(start, goal))) return Found{start, goal, *other_goal, meeting};
    }
    return std::nullopt;
  }

  std::vector<Meeting> meetings_with(const QuickestWays& ways, StationId goal, const std::vector<StationId>& starts) {
    std::vector<Meeting> found;
    const auto lanes = ways.lanes(map_, goal);
    for (const auto start : starts) {
      if (start == ways.from) continue;
      const auto& other = timetable_.from(start);
      for (const auto l : lanes) {
        const auto& lane = map_.lanes()[l];
        if (!ties_)
          consider(found, {start, lane.from, apart(ways.drives_off[lane.to.index()], other.drives_off[lane.from.index()]), true}, other, lane);
        consider(found, {start, lane.to, apart(ways.arrives[lane.to.index()], other.arrives[lane.to.index()]), false}, other, lane);
      }
    }
    return found;
  }

  static Duration apart(Duration a, Duration b) { return a < b ? b - a : a - b; }

  void consider(std::vector<Meeting>& found, const Meeting& meeting, const QuickestWays& other, const Lane& lane) const {
    if (meeting.apart >= kWithin || other.unique[meeting.through.index()] == 0) return;
    const auto last = other.arrival_lane[meeting.through.index()];
    if (last == QuickestWays::kNone) return;
    // Head-on the other drives the same segment; at a station it comes by another one.
    if ((map_.lanes()[last].segment == lane.segment) == meeting.head_on) found.push_back(meeting);
  }

  // Of the goals to which the quickest way from the start leads through the meeting, or ends there.
  std::optional<StationId> goal_through(const Meeting& meeting, Draws& draws) {
    const auto& ways = timetable_.from(meeting.start);
    std::vector<StationId> through;
    for (const auto goal : goals_) {
      if (goal == meeting.start || ways.unique[goal.index()] == 0) continue;
      for (StationId s = goal; s != meeting.start; s = map_.lanes()[ways.arrival_lane[s.index()]].from) {
        if (s != meeting.through) continue;
        through.push_back(goal);
        break;
      }
    }
    if (through.empty()) return std::nullopt;
    return through[draws.below(static_cast<std::uint32_t>(through.size()))];
  }

  Vec2 heading(StationId start, StationId goal) { return map_.lanes()[timetable_.from(start).lanes(map_, goal).front()].curve.pose_at(0.0).heading; }

  bool add(StationId start, StationId goal, RejectionCounts& counts) { return add_agv(scenario_, start, heading(start, goal), counts); }

  // Whether an AGV finds room, after the first of its pair if that is given. Nobody is left standing.
  bool has_room(StationId start, StationId goal, std::optional<std::pair<StationId, StationId>> after) {
    const std::size_t before = scenario_.agvs.size();
    RejectionCounts tried;
    const bool room = (!after || add(after->first, after->second, tried)) && add(start, goal, tried);
    scenario_.agvs.resize(before);
    return room;
  }

  Scenario& scenario_;
  const LogicalMap& map_;
  RejectionCounts& counts_;
  bool ties_;
  Timetable timetable_;
  std::vector<StationId> starts_, core_, goals_;
};

}  // namespace

std::vector<EncounterPair> place_pairs(Scenario& scenario, std::uint32_t fleet_size, Placement placement, const Reachability& reachability,
                                       std::uint64_t key, std::uint32_t attempt, RejectionCounts& counts) {
  std::vector<EncounterPair> pairs;
  if (reachability.core().size() < 2) return pairs;
  PairMaker maker(scenario, reachability, placement == Placement::Symmetric, counts);
  while (scenario.agvs.size() + 2 <= fleet_size) {
    ++counts.pairs_wanted;
    const auto pair = maker.make(Draws(key, attempt, static_cast<std::uint32_t>(scenario.agvs.size())));
    if (!pair) break;
    pairs.push_back(*pair);
    ++counts.pairs_made;
  }
  return pairs;
}

void send_to_meet(Scenario& scenario, const std::vector<EncounterPair>& pairs) {
  const auto begin_at = [](TransportOrder& order, StationId goal) {
    if (order.to == goal) order.to = order.from;
    order.from = goal;
  };
  for (const auto& pair : pairs) {
    auto& first = scenario.agvs[pair.first].transports;
    auto& second = scenario.agvs[pair.second].transports;
    if (first.empty() || second.empty()) continue;
    first[0].release = second[0].release = std::min(first[0].release, second[0].release);
    begin_at(first[0], pair.first_goal);
    begin_at(second[0], pair.second_goal);
  }
}

}  // namespace fleetproof
