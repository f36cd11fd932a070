#include "core/agents/section_planner.hpp"

#include <algorithm>
#include <cmath>

#include "core/agents/fleet_routes.hpp"
#include "core/agents/lane_costs.hpp"

namespace fleetproof::agents {
namespace {

constexpr double kLookAhead_m = 12.0;
constexpr std::uint32_t kWaysKnown = 8;  // if it does not hear of all, it knows the ways of so many
constexpr double kFar_m = 70.0;          // in a divided fleet, a search for a way ends there
constexpr std::uint32_t kLookAheadLanes = 3;
constexpr double kOnward_m = 40.0, kOnwardInZones_m = 18.0;  // what is announced beyond a section

// The price of a place at which another AGV stands or arrives: roughly the time until that AGV has moved.
constexpr double kArrivingCost_s = 8.0;
constexpr double kIdleCost_s = 10.0;
constexpr double kWaitingCost_s = 20.0;
constexpr double kNoWayCost_s = 1000.0;
// Of a place that another AGV asks for, and of one at which the two lock each other in.
constexpr double kAskedForCost_s = 60.0;
constexpr double kCrampedCost_s = 60.0;
// Of one that an AGV leaves only with an order that changes its load: another place is better, but others may have to
// get past it now.
constexpr double kNoWayBackCost_s = 300.0;
// As bad as to cut off one goal.
constexpr std::uint32_t kCrampedBurden = 1;

}  // namespace

bool carries_load(std::span<const Goal> goals) {
  const auto next = std::ranges::find_if(goals, [](const Goal& goal) { return goal.transfer != Leg::Kind::Charge; });
  return next != goals.end() && next->transfer == Leg::Kind::Drop;
}

void cut_after_first_lane(Section& section) {
  const auto drives = [](const Leg& leg) { return leg.kind == Leg::Kind::Drive; };
  const auto first = std::ranges::find_if(section.legs, drives);
  if (first == section.legs.end()) return;
  section.legs.erase(first + 1, section.legs.end());
  section.path.count = 1;
  section.goals = static_cast<std::uint32_t>(first - section.legs.begin());
}

// A section that grows lane by lane and remembers the best end so far.
struct SectionPlanner::Walk {
  struct End {
    std::size_t legs = 0;
    std::uint32_t lanes = 0, goals = 0;
  };

  Walk(SectionPlanner& of, const Path& standing, Budget allowed) : planner(of), budget(allowed) {
    section.path = standing;
    planner.reachable_.clear();
    for_each_on_the_way(planner.neighbours_, [&](std::uint32_t agv, const Neighbour& n) {
      if (!n.known) return;
      const double after_m = planner.geometry_.meets_after_m(self(), standing.station, agv, n.status.held);
      if (after_m <= budget.length_m) planner.reachable_.push_back({agv, &n, after_m});
    });
  }

  SectionPlanner& planner;
  Budget budget;
  Section section;
  double length_m = 0.0;
  bool blocked = false;  // it reaches floor that another AGV is known to hold
  End here, best, least_bad;
  bool best_is_roomy = false;
  std::uint32_t least_burden = ~0U;

  std::uint32_t self() const { return planner.neighbours_.self(); }
  std::uint32_t station() const { return end_of(planner.map_, section.path).station; }

  // False if the budget does not allow this lane.
  bool drive(std::uint32_t lane) {
    length_m += planner.map_.lane(lane).length_m;
    if (length_m > budget.length_m || here.lanes >= budget.lanes || !section.path.append(lane)) return false;
    section.legs.push_back({Leg::Kind::Drive, lane});
    ++here.lanes;
    blocked = blocked || any_within_reach([&](std::uint32_t agv, const Neighbour& n) {
                return planner.geometry_.lane_conflict(self(), lane, agv, n.status.held);
              });
    note_end();
    return true;
  }

  void transfer(const Goal& goal) {
    section.legs.push_back({goal.transfer, FP_NONE, goal.order});
    ++here.goals;
    note_end();
  }

  template <class F>
  bool any_within_reach(F is) const {
    return std::ranges::any_of(planner.reachable_, [&](const Reachable& other) {
      return other.after_m <= length_m && is(other.agv, *other.neighbour);
    });
  }

  // Two AGVs that stand so near to each other that none of them can turn may stay for ever.
  bool is_cramped() const {
    return any_within_reach(
        [&](std::uint32_t agv, const Neighbour& n) { return planner.is_cramped(station(), agv, n); });
  }

  void note_end() {
    here.legs = section.legs.size();
    if (here.lanes == 0) return;
    std::uint32_t burden = planner.places_.burden(station());
    const bool roomy = burden != 0 || !is_cramped();
    if (!roomy && planner.may_turn_back(station())) burden = kCrampedBurden;
    if (burden == 0 && (best.lanes == 0 || (!blocked && (roomy || !best_is_roomy)))) {
      best = here;
      best_is_roomy = !blocked && roomy;
    }
    if (burden <= least_burden) {
      least_burden = burden;
      least_bad = here;
    }
  }

  // True if a longer section would not be better.
  bool is_done() const {
    if (best.lanes == 0) return false;
    if (blocked) return true;
    const bool far_enough = length_m >= kLookAhead_m || here.lanes >= kLookAheadLanes || here.goals > 0;
    return far_enough && best.lanes == here.lanes;
  }

  // Also if this is not a place to wait at, unless other AGVs are in the way.
  Section take_up_to_here() {
    if (!blocked || best.lanes == 0) best = here;
    return take();
  }

  Section take() {
    const End& end = best.lanes > 0 ? best : least_bad;
    section.legs.resize(end.legs);
    section.path.count = end.lanes;
    section.goals = end.goals;
    return std::move(section);
  }
};

SectionPlanner::SectionPlanner(const MapView& map, HullGeometry& geometry, Neighbours& neighbours,
                               std::uint32_t vehicle_type, const ProgressOptions& options)
    : map_(map),
      geometry_(geometry),
      neighbours_(neighbours),
      places_(map, geometry),
      rules_(map, vehicle_type),
      routes_(map, rules_),
      lane_times_s_(agents::lane_times_s(geometry.parts().facts(), neighbours.self())),
      prices_(map, rules_, options.one_way_aisles ? lane_costs_s(geometry.parts(), neighbours.self()) : lane_times_s_,
              neighbours.audience().hears_of_all() ? neighbours.fleet_count() : kWaysKnown),
      model_(model_of(geometry.parts().facts(), neighbours.self())),
      knows_remaining_costs_(options.one_way_aisles) {}

void SectionPlanner::search(const Path& from, std::uint32_t goal) {
  if (!knows_remaining_costs_) return routes_.search(from.station, from.heading, prices_.costs_s(), goal);
  const auto remains_s = remaining_costs_s(geometry_.parts(), model_, goal);
  routes_.search_towards(goal, remains_s, from.station, from.heading, prices_.costs_s(),
                         neighbours_.audience().is_divided() ? kFar_m : INFINITY);
}

// A goal, or a station on the way to it, further away than what is planned now.
std::uint32_t SectionPlanner::end_of_search(std::uint32_t goal) const {
  return neighbours_.audience().is_divided() && routes_.reached() != FP_NONE ? routes_.reached() : goal;
}

// A waiting AGV asks again and again, and often nothing has changed.
Section SectionPlanner::towards(const Path& standing, Budget budget, std::span<const Goal> goals) {
  if (!is_asked_again(standing, budget, goals)) {
    last_answer_ = find_section(standing, budget, goals);
    last_asked_ = {standing, budget, {goals.begin(), goals.end()}, neighbours_.changes()};
  }
  return last_answer_;
}

bool SectionPlanner::is_asked_again(const Path& standing, Budget budget, std::span<const Goal> goals) const {
  return last_asked_ && last_asked_->changes == neighbours_.changes() && last_asked_->budget == budget &&
         is_identical(last_asked_->standing, standing) && std::ranges::equal(last_asked_->goals, goals);
}

Section SectionPlanner::find_section(const Path& standing, Budget budget, std::span<const Goal> goals) {
  bool loaded = carries_load(goals);
  price_lanes(loaded, kWaitingCost_s, kIdleCost_s, {});
  Walk walk(*this, standing, budget);
  for (const Goal& goal : goals) {
    const Path here = end_of(map_, walk.section.path);
    if (here.station != goal.station || !map_.may_stay(here.station, here.heading)) {
      search(here, goal.station);
      const std::uint32_t end = end_of_search(goal.station);
      if (!follow(walk, end) || end != goal.station) return walk.take();
    }
    walk.transfer(goal);
    if (goal.transfer == Leg::Kind::Charge) return walk.take_up_to_here();  // it stays there, and nothing is behind it
    if (walk.is_done()) return walk.take();
    const bool now_loaded = goal.transfer == Leg::Kind::Pick;
    if (rules_.any() && now_loaded != loaded) price_lanes(now_loaded, kWaitingCost_s, kIdleCost_s, {});
    loaded = now_loaded;
  }
  const std::uint32_t place = best_place(end_of(map_, walk.section.path), false, 0.0, {});
  if (place != FP_NONE) follow(walk, place);
  return walk.take();
}

std::vector<std::uint32_t> SectionPlanner::way_on_from(const Section& section, std::span<const Goal> goals) {
  std::vector<std::uint32_t> lanes;
  const double enough_m = neighbours_.audience().is_divided() ? kOnwardInZones_m : kOnward_m;
  double length_m = 0.0;
  Path from = end_of(map_, section.path);
  const auto ahead = goals.subspan(section.goals);
  for (std::size_t next = 0; next < ahead.size(); ++next) {
    const Goal& goal = ahead[next];
    if (length_m >= enough_m) break;
    if (rules_.any()) price_lanes(carries_load(ahead.subspan(next)), kWaitingCost_s, kIdleCost_s, {});
    search(from, goal.station);
    const auto way = routes_.lanes(end_of_search(goal.station));
    if (way.empty() && from.station != goal.station) break;
    for (const std::uint32_t lane : way) {
      if (length_m >= enough_m) break;
      lanes.push_back(lane);
      length_m += map_.lane(lane).length_m;
      from.heading = map_.end_heading(lane);
    }
    if (end_of_search(goal.station) != goal.station) break;
    from.station = goal.station;
  }
  return lanes;
}

Section SectionPlanner::out_of_the_way(const Path& standing, Budget budget, bool loaded, bool prefer_parking,
                                       double draw, const GoesFirst& goes_first) {
  for (const bool through_waiting : {false, true}) {
    price_lanes(loaded, through_waiting ? kWaitingCost_s : kNoWayCost_s, through_waiting ? kIdleCost_s : kNoWayCost_s,
                goes_first);
    const std::uint32_t place = best_place(standing, prefer_parking, draw, goes_first);
    if (place == FP_NONE) continue;
    Walk walk(*this, standing, budget);
    for (const std::uint32_t lane : routes_.lanes(place)) {
      if (!walk.drive(lane)) return walk.take();
    }
    walk.best = walk.here;  // best_place() chose this place, even if it is not safe
    return walk.take();
  }
  return {};
}

std::uint32_t SectionPlanner::free_charger(const Path& standing, bool loaded, bool urgent) {
  price_lanes(loaded, kWaitingCost_s, kIdleCost_s, {});
  routes_.search(standing.station, standing.heading, prices_.costs_s());
  return quickest_charger(map_, routes_, places_, urgent, [&](std::uint32_t station) { return is_taken(station); });
}

// By an AGV that stands there, or will soon. Of two that go to a charger, the one with the smaller number gets it.
bool SectionPlanner::is_taken(std::uint32_t station) {
  const auto ends_there = [&](std::uint32_t lane) { return map_.lane(lane).to == station; };
  bool taken = false;
  for_each_on_the_way(neighbours_, [&](std::uint32_t agv, const Neighbour& n) {
    if (taken || !n.known) return;
    taken = geometry_.turn_conflict(neighbours_.self(), station, agv, end_of(map_, n.status.held)) ||
            (agv < neighbours_.self() && std::ranges::any_of(n.status.ahead.lanes(), ends_there));
  });
  return taken;
}

// Extends the walk to a station. False if the walk ends before, or cannot go on.
bool SectionPlanner::follow(Walk& walk, std::uint32_t to) {
  const auto lanes = routes_.lanes(to);
  if (lanes.empty()) return false;
  for (const std::uint32_t lane : lanes) {
    if (!walk.drive(lane)) return false;
    if (lane != lanes.back() && walk.is_done()) return false;
  }
  return true;
}

void SectionPlanner::price_lanes(bool loaded, double waiting_s, double idle_s, const GoesFirst& goes_first) {
  last_asked_.reset();
  prices_.begin(loaded);
  for_each_on_the_way(neighbours_, [&](std::uint32_t agv, const Neighbour& n) {
    if (!n.known) return;
    const Status& status = n.status;
    const bool wall = status.out_of_order || (status.waiting && goes_first && goes_first(agv, n));
    const double extra_s = wall ? kNoWayCost_s : !status.waiting ? kArrivingCost_s : status.idle ? idle_s : waiting_s;
    prices_.price_station(end_of(map_, status.held).station, extra_s);
    prices_.price_meetings(status.held);
    prices_.price_meetings(status.ahead);
  });
}

// Afterwards, the way there may be asked for.
std::uint32_t SectionPlanner::best_place(const Path& standing, bool prefer_parking, double draw,
                                         const GoesFirst& goes_first) {
  std::uint32_t best = FP_NONE;
  double best_s = INFINITY;
  const auto look_at = [&](std::uint32_t station, double way_s) {
    if (way_s >= std::min(best_s, kNoWayCost_s)) return true;
    if (station == standing.station || (rules_.any() && !leads_on(station))) return false;
    double cost_s = way_s;
    if (rules_.any() && !leads_back(station)) cost_s += kNoWayBackCost_s;
    if (prefer_parking && (map_.station(station).purposes & FP_PARKING) == 0) cost_s += 10.0;
    // Every draw prefers other stations, so that two AGVs that block each other do not repeat the same choice.
    cost_s += 12.0 * draw * ((station * 7 + 3) % 5) / 4.0;
    if (cost_s < best_s) cost_s += std::min(5.0 * places_.burden(station), 200.0);
    if (cost_s < best_s) cost_s += price_of_staying(station, best_s - cost_s, goes_first);
    if (cost_s < best_s) best = station, best_s = cost_s;
    return false;
  };
  routes_.search_until(look_at, standing.station, standing.heading, prices_.costs_s());
  return best;
}

// False where an AGV with the load for which lanes were priced cannot leave before it has picked or dropped.
bool SectionPlanner::leads_on(std::uint32_t station) const {
  return std::ranges::any_of(map_.lanes_from(station),
                             [&](std::uint32_t lane) { return prices_.costs_s()[lane] < INFINITY; });
}

// Whether an AGV with the load for which lanes were priced can come back from there as it is.
bool SectionPlanner::leads_back(std::uint32_t station) const {
  return std::ranges::any_of(map_.lanes_from(station),
                             [&](std::uint32_t lane) { return rules_.leads_back(lane, prices_.loaded()); });
}

// Infinite if another AGV holds the place. Beyond `limit_s`, it is not worked out further.
double SectionPlanner::price_of_staying(std::uint32_t station, double limit_s, const GoesFirst& goes_first) {
  double price_s = 0.0;
  for_each_on_the_way(neighbours_, [&](std::uint32_t agv, const Neighbour& n) {
    if (!n.known || price_s >= limit_s) return;
    bool held = geometry_.turn_conflict(neighbours_.self(), station, agv, n.status.held);
    if (!held && n.request_is_open() && geometry_.turn_conflict(neighbours_.self(), station, agv, n.request)) {
      price_s += kAskedForCost_s;
      held = goes_first && goes_first(agv, n);
    }
    if (held) price_s = INFINITY;
    if (!held && is_cramped(station, agv, n)) price_s += kCrampedCost_s;
  });
  return price_s;
}

bool SectionPlanner::may_turn_back(std::uint32_t station) const {
  return std::ranges::any_of(map_.lanes_from(station), [&](std::uint32_t lane) { return map_.two_way(lane); });
}

// Whether the other AGV, at the end of its way, could not turn while this AGV turns at `station`: each could lock the
// other in.
bool SectionPlanner::is_cramped(std::uint32_t station, std::uint32_t agv, const Neighbour& n) {
  const std::uint32_t self = neighbours_.self();
  return geometry_.turns_conflict(self, station, agv, end_of(map_, n.status.held).station);
}

}  // namespace fleetproof::agents
