#include "core/agents/quickest_way.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/agents/lane_chains.hpp"
#include "core/agents/lane_costs.hpp"
#include "core/agents/near_queue.hpp"

namespace fleetproof::agents {
namespace {

// Sums of the same times in another order differ by less.
constexpr double kRounding = 1e-9;
constexpr double kSurelyTakes_s = 1e-3;  // more than rounding, on any way of less than a week
// Small maps are searched sooner than their landmarks.
constexpr std::uint32_t kFewestStations = 1000, kLandmarks = QuickestWay::kLandmarks;
constexpr std::size_t kWidthsInALane = 4;

using Two = double __attribute__((vector_size(16)));  // two numbers, with which the processor calculates at once

struct Open {
  double cost_s;
  std::uint32_t station;
};

constexpr auto is_later = [](const Open& a, const Open& b) {
  return a.cost_s != b.cost_s ? a.cost_s > b.cost_s : a.station > b.station;
};

void push(std::vector<Open>& open, Open next) {
  open.push_back(next);
  std::ranges::push_heap(open, is_later);
}

Open pop(std::vector<Open>& open) {
  std::ranges::pop_heap(open, is_later);
  const Open least = open.back();
  open.pop_back();
  return least;
}

// For a NearQueue: few stations lie within it.
double width_s(std::span<const double> times_s) {
  double sum_s = 0.0;
  for (const double time_s : times_s) sum_s += time_s;
  return sum_s > 0.0 ? sum_s / static_cast<double>(kWidthsInALane * times_s.size()) : 1.0;
}

bool is_quick(double with_lane_s, double all_s) { return with_lane_s <= all_s * (1.0 + kRounding); }

// By which a search goes on from a station that is in no chain: lanes and chains.
struct Steps {
  std::vector<QuickestWay::Step> steps;
  std::vector<std::uint32_t> first;  // by station, and one more

  Steps(std::span<const ChainArc> arcs, std::size_t stations, bool back) : steps(arcs.size()), first(stations + 1) {
    for (const ChainArc& arc : arcs) ++first[(back ? arc.to : arc.from) + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (const ChainArc& arc : arcs) steps[next[back ? arc.to : arc.from]++] = {arc.time_s, back ? arc.from : arc.to};
  }
};

void derive_plant(const fp_facts* from, std::uint64_t agv, fp_answer* to) {
  const auto lane_s = lane_times_s(*from, static_cast<std::uint32_t>(agv));
  const LaneChains chains(MapView(*from), lane_s);
  const Steps back(chains.arcs, chains.places.size(), true);
  TableWriter tables;
  tables.add(chains.places, back.steps, back.first, std::vector<double>{width_s(lane_s)}, chains.arcs);
  answer(*from, to, tables.bytes());
}

// By station, of those that are in no chain; infinite where there is no way.
std::vector<double> least_times_s(NearQueue& open, double width_s, const Steps& steps, std::uint32_t begin) {
  std::vector<double> least_s(steps.first.size() - 1, INFINITY), looked_from_s = least_s;
  open.begin(0.0, width_s);
  open.push(0.0, begin);
  least_s[begin] = 0.0;
  while (open.find_next()) {
    const std::uint32_t here = open.pop();
    const double so_far_s = least_s[here];
    if (so_far_s >= looked_from_s[here]) continue;
    looked_from_s[here] = so_far_s;
    for (std::uint32_t i = steps.first[here]; i < steps.first[here + 1]; ++i) {
      const auto& [time_s, there] = steps.steps[i];
      const double sum_s = so_far_s + time_s;
      if (sum_s >= least_s[there]) continue;
      least_s[there] = sum_s;
      open.push(sum_s, there);
    }
  }
  return least_s;
}

// Each landmark is the station that is farthest from all landmarks before it, of those that they reach and that are in
// no chain. Searches ask for those only.
void derive_landmarks(const fp_facts* from, std::uint64_t agv, fp_answer* to) {
  TableReader plant(ask<std::byte>(*from, derive_plant, agv));
  const auto places = plant.next<ChainPlace>();
  plant.next<QuickestWay::Step>(), plant.next<std::uint32_t>();
  const double width = plant.next<double>().front();
  const auto arcs = plant.next<ChainArc>();
  const Steps onward(arcs, places.size(), false), back(arcs, places.size(), true);
  std::vector<double> table(std::size_t{2} * kLandmarks * places.size());
  std::vector<double> apart_s(places.size(), INFINITY);
  NearQueue open;
  std::uint32_t landmark = places.front().end[0];
  for (std::uint32_t i = 0; i < kLandmarks; ++i) {
    const auto there_s = least_times_s(open, width, onward, landmark),
               back_s = least_times_s(open, width, back, landmark);
    for (std::uint32_t station = 0; station < places.size(); ++station) {
      if (places[station].is_inside()) {
        apart_s[station] = 0.0;
        continue;
      }
      double* row = table.data() + std::size_t{2} * (std::size_t{kLandmarks} * station + i);
      row[0] = there_s[station], row[1] = -back_s[station];
      if (there_s[station] < INFINITY) apart_s[station] = std::min(apart_s[station], there_s[station]);
      if (apart_s[station] == INFINITY) apart_s[station] = 0.0;
    }
    landmark = static_cast<std::uint32_t>(std::ranges::max_element(apart_s) - apart_s.begin());
  }
  answer(*from, to, table);
}

}  // namespace

// Where searches work, and what the searches under way have found out about a station: the time that remains from it,
// by the search backward; the time up to it and the lane by which the way arrives, by the search forward. All AGVs of a
// thread share it: one of each would be as large as the map, and most of the map is never looked at.
struct QuickestWay::Desk {
  struct Station {
    std::uint64_t back = 0, forward = 0;  // the searches that found this out; it is worth nothing to others
    double remains_s = INFINITY, looked_from_s = INFINITY;  // and what remained when the search went on from here
    double cost_s = INFINITY;
    std::uint32_t arrival = FP_NONE;
  };
  std::vector<Station> stations;
  NearQueue open_back;
  std::vector<Open> open;                // heap, least first, of the search forward
  std::uint64_t searches = 0, back = 0;  // so far; the last search backward

  static Desk& of_this_thread(std::uint32_t station_count) {
    thread_local Desk desk;
    if (desk.stations.size() < station_count) desk.stations.resize(station_count);
    return desk;
  }
  void begin_back(double nearest_s, double width_s) {
    open_back.begin(nearest_s, width_s);
    back = ++searches;
  }
  void begin_forward() {
    open.clear();
    ++searches;
  }
  Station& known_back(std::uint32_t number) {
    Station& station = stations[number];
    if (station.back != back) station.back = back, station.remains_s = station.looked_from_s = INFINITY;
    return station;
  }
  Station& known_forward(std::uint32_t number) {
    Station& station = stations[number];
    if (station.forward != searches) station.forward = searches, station.cost_s = INFINITY;
    return station;
  }
  double remains_s(std::uint32_t number) const {
    return stations[number].back == back ? stations[number].remains_s : INFINITY;
  }
};

QuickestWay::QuickestWay(const fp_facts& facts, const MapView& map, const Routes& routes, std::uint32_t agv)
    : map_(map),
      routes_(routes),
      times_s_(lane_times_s(facts, agv)),
      has_landmarks_(map.station_count() >= kFewestStations) {
  const std::uint32_t model = model_of(facts, agv);
  TableReader tables(ask<std::byte>(facts, derive_plant, model));
  places_ = tables.next<ChainPlace>();
  steps_back_ = tables.next<Step>();
  first_steps_ = tables.next<std::uint32_t>();
  width_s_ = tables.next<double>().front();
  if (has_landmarks_) landmarks_s_ = ask<double>(facts, derive_landmarks, model);
}

// The time from a landmark, or to it below zero. The tables hold it for stations outside of chains only.
double QuickestWay::landmark_s(std::uint32_t column, std::uint32_t station) const {
  const ChainPlace& place = places_[station];
  const auto at_end_s = [&](std::size_t i) {
    return landmarks_s_[std::size_t{2} * kLandmarks * place.end[i] + column];
  };
  if (!place.is_inside()) return at_end_s(0);
  if (column % 2 == 0) return std::min(place.from_end_s[0] + at_end_s(0), place.from_end_s[1] + at_end_s(1));
  return std::max(at_end_s(0) - place.to_end_s[0], at_end_s(1) - place.to_end_s[1]);
}

QuickestWay::Bound QuickestWay::bound_from(std::uint32_t station) const {
  Bound bound{};
  for (std::uint32_t column = 0; has_landmarks_ && column < bound.size(); ++column)
    bound[column] = landmark_s(column, station);
  return bound;
}

// A way that begins at a landmark, or ends there, is not shorter for a detour.
inline double QuickestWay::least_s(const Bound& bound, std::uint32_t station) const {
  if (!has_landmarks_) return 0.0;
  const double* there = landmarks_s_.data() + bound.size() * station;
  Two least_s{};
#pragma GCC unroll 4
  for (std::size_t column = 0; column < bound.size(); column += 2) {
    const Two further_s = Two{there[column], there[column + 1]} - Two{bound[column], bound[column + 1]};
    least_s = further_s > least_s ? further_s : least_s;
  }
  return std::max(least_s[0], least_s[1]) * (1.0 - kRounding);
}

void QuickestWay::search_back(Desk& desk, std::uint32_t from, std::uint32_t to) const {
  const Bound bound = bound_from(from);
  const auto until = [](double way_s) { return way_s * (1.0 + 10.0 * kRounding); };  // all that may be as quick
  NearQueue& open = desk.open_back;
  const auto reach = [&, bound](std::uint32_t station, double remains_s, double until_s) {
    Desk::Station& known = desk.known_back(station);
    if (remains_s >= known.remains_s) return;
    const double with_start_s = remains_s + least_s(bound, station);
    if (with_start_s > until_s) return;
    known.remains_s = remains_s;
    open.push(with_start_s, station);
  };
  const ChainPlace &start = places_[from], &goal = places_[to];
  double nearest_s = INFINITY;
  for (std::size_t i = 0; i < 2; ++i) {
    if (goal.from_end_s[i] < INFINITY)
      nearest_s = std::min(nearest_s, goal.from_end_s[i] + least_s(bound, goal.end[i]));
  }
  desk.begin_back(nearest_s, width_s_);
  double until_s = until(along_chain_s(from, to));
  for (std::size_t i = 0; i < 2; ++i) {
    if (goal.from_end_s[i] < INFINITY) reach(goal.end[i], goal.from_end_s[i], until_s);
  }
  while (open.find_next() && open.next_distance() <= until_s) {
    const std::uint32_t here = open.pop();
    Desk::Station& station = desk.stations[here];
    const double so_far_s = station.remains_s;
    if (so_far_s >= station.looked_from_s) continue;
    station.looked_from_s = so_far_s;
    for (std::size_t i = 0; i < 2; ++i) {
      if (here == start.end[i]) until_s = std::min(until_s, until(so_far_s + start.to_end_s[i]));
    }
    if (here == from) continue;
    const auto [first, end] = std::tie(first_steps_[here], first_steps_[here + 1]);
    for (const Step& step : steps_back_.subspan(first, end - first)) reach(step.to, so_far_s + step.time_s, until_s);
  }
}

std::uint32_t QuickestWay::next_lane(std::uint32_t from, std::uint32_t to) {
  if (goal_ != to || at_ != from || way_.empty()) plan(from, to);
  goal_ = to;
  at_ = from;
  if (way_.empty()) return FP_NONE;
  const std::uint32_t next = way_.back();
  way_.pop_back();
  at_ = map_.lane(next).to;
  return next;
}

void QuickestWay::plan(std::uint32_t from, std::uint32_t to) {
  way_.clear();
  Desk& desk = Desk::of_this_thread(map_.station_count());
  search_back(desk, from, to);
  if (remains_s(desk, from, to) == INFINITY) return;
  // A way passes no station twice. If it seems to, the rest is asked for later.
  std::uint32_t before = FP_NONE;
  for (std::uint32_t at = from; at != to && way_.size() < map_.station_count();) {
    const Hop next = quick_hop(desk, before, at, to);
    way_.push_back(next.lane);
    before = std::exchange(at, next.to);
  }
  std::ranges::reverse(way_);
}

// Without leaving the chain; infinite if they are not in one.
double QuickestWay::along_chain_s(std::uint32_t from, std::uint32_t to) const {
  if (from == to) return 0.0;
  const ChainPlace &here = places_[from], &there = places_[to];
  double least_s = INFINITY;
  if (!here.is_inside() || here.chain != there.chain) return least_s;
  for (std::size_t i = 0; i < 2; ++i) {
    const double time_s = there.from_end_s[i] - here.from_end_s[i];
    if (time_s >= 0.0) least_s = std::min(least_s, time_s);
  }
  return least_s;
}

// The search has found out about stations that are in no chain.
double QuickestWay::remains_s(const Desk& desk, std::uint32_t station, std::uint32_t to) const {
  const ChainPlace& here = places_[station];
  if (!here.is_inside()) return desk.remains_s(station);
  double least_s = along_chain_s(station, to);
  for (std::size_t i = 0; i < 2; ++i) least_s = std::min(least_s, here.to_end_s[i] + desk.remains_s(here.end[i]));
  return least_s;
}

// Back to the station before, which lies on the way, is never quick.
QuickestWay::Hop QuickestWay::quick_hop(Desk& desk, std::uint32_t before, std::uint32_t from, std::uint32_t to) const {
  const auto hops = routes_.hops_from(from);
  if (hops.size() == 1) return hops.front();
  const auto is_back = [&](const Hop& hop) { return hop.to == before && times_s_[hop.lane] > kSurelyTakes_s; };
  if (hops.size() == 2 && is_back(hops[0])) return hops[1];
  if (hops.size() == 2 && is_back(hops[1])) return hops[0];
  const double all_s = remains_s(desk, from, to);
  Hop next{FP_NONE, FP_NONE};
  std::uint32_t quick = 0;
  for (const Hop& hop : hops) {
    if (is_back(hop) || !is_quick(times_s_[hop.lane] + remains_s(desk, hop.to, to), all_s)) continue;
    next = hop;
    ++quick;
  }
  if (quick <= 1) return next;
  const std::uint32_t lane = search_forward(desk, from, to);
  return {lane, map_.lane(lane).to};
}

// The search of Routes::search, but only over stations that lie on a quickest way. Other stations cannot change
// the result: no way through them reaches a station of a quickest way at so small a cost.
std::uint32_t QuickestWay::search_forward(Desk& desk, std::uint32_t from, std::uint32_t to) const {
  desk.begin_forward();
  const double all_s = remains_s(desk, from, to);
  desk.known_forward(from).cost_s = 0.0;
  push(desk.open, {0.0, from});
  while (!desk.open.empty()) {
    const auto [so_far_s, here] = pop(desk.open);
    if (here == to) break;
    if (so_far_s > desk.known_forward(here).cost_s) continue;
    for (const auto& [lane, end] : routes_.hops_from(here)) {
      const double sum_s = so_far_s + times_s_[lane];
      if (!is_quick(sum_s + remains_s(desk, end, to), all_s)) continue;
      Desk::Station& station = desk.known_forward(end);
      if (sum_s >= station.cost_s) continue;
      station.cost_s = sum_s;
      station.arrival = lane;
      push(desk.open, {sum_s, end});
    }
  }
  std::uint32_t first = desk.known_forward(to).arrival;
  while (map_.lane(first).from != from) first = desk.known_forward(map_.lane(first).from).arrival;
  return first;
}

}  // namespace fleetproof::agents
