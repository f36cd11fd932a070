#include "core/agents/quickest_way.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/agents/lane_costs.hpp"

namespace fleetproof::agents {
namespace {

// Sums of the same times in another order differ by less.
constexpr double kRounding = 1e-9;
constexpr std::size_t kStretch = 16;     // many an AGV stops, or the run, before it has driven more
constexpr double kSurelyTakes_s = 1e-3;  // more than rounding, on any way of less than a week

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

bool is_quick(double with_lane_s, double all_s) { return with_lane_s <= all_s * (1.0 + kRounding); }

// The question names the model of the AGV.
void derive_tree(const fp_facts* from, std::uint64_t model, fp_answer* to) {
  const auto times_s = lane_times_s(*from, static_cast<std::uint32_t>(model));
  answer(*from, to, EliminationTree::bytes(MapView(*from), times_s));
}

}  // namespace

// What is known about stations while a way is planned. All AGVs of a thread share it: one of each would be as large as
// the map, and most of the map is never looked at.
struct QuickestWay::Desk {
  // The time from a station to the goal: as found by climbing from the goal, or least, once it is settled.
  struct Rest {
    double remains_s = INFINITY;
    std::uint64_t known = 0;  // twice the number of the plan that knows it, and one if it is settled
  };
  // Of a search forward: the time up to a station, and the lane by which the way arrives.
  struct Reached {
    double cost_s = INFINITY;
    std::uint32_t arrival = FP_NONE;
    std::uint64_t search = 0;
  };
  std::vector<Rest> rest;            // by station
  std::vector<Reached> reached;      // by station
  std::vector<std::uint32_t> climb;  // has room for all stations
  std::vector<Open> open;            // heap, least first, of the search forward
  std::uint64_t plans = 0, searches = 0;

  static Desk& of_this_thread(std::uint32_t station_count) {
    thread_local Desk desk;
    if (desk.rest.size() >= station_count) return desk;
    desk.rest.resize(station_count), desk.reached.resize(station_count), desk.climb.resize(station_count);
    return desk;
  }
  bool is_settled(std::uint32_t station) const { return rest[station].known == 2 * plans + 1; }
  void begin_forward() {
    open.clear();
    ++searches;
  }
  Reached& known_forward(std::uint32_t station) {
    Reached& known = reached[station];
    if (known.search != searches) known = {INFINITY, FP_NONE, searches};
    return known;
  }
};

QuickestWay::QuickestWay(const fp_facts& facts, const MapView& map, const Routes& routes, std::uint32_t agv)
    : map_(map),
      routes_(routes),
      times_s_(lane_times_s(facts, agv)),
      tree_(ask<std::byte>(facts, derive_tree, model_of(facts, agv))) {}

// Of ways that only descend to the goal.
void QuickestWay::climb_from(Desk& desk, std::uint32_t goal) const {
  ++desk.plans;
  for (std::uint32_t at = goal; at != FP_NONE; at = tree_.parent(at)) desk.rest[at] = {INFINITY, 2 * desk.plans};
  desk.rest[goal].remains_s = 0.0;
  for (std::uint32_t at = goal; at != FP_NONE; at = tree_.parent(at)) {
    const double so_far_s = desk.rest[at].remains_s;
    for (const EliminationTree::Arc& arc : tree_.arcs(at)) {
      double& remains_s = desk.rest[arc.to].remains_s;
      remains_s = std::min(remains_s, so_far_s + arc.back_s);
    }
  }
}

// Infinite if there is no way. Ways that climb first go on as the quickest way of an ancestor.
double QuickestWay::remains_s(Desk& desk, std::uint32_t station) const {
  std::size_t climbed = 0;
  for (std::uint32_t at = station; at != FP_NONE && !desk.is_settled(at); at = tree_.parent(at))
    desk.climb[climbed++] = at;
  while (climbed > 0) {
    const std::uint32_t at = desk.climb[--climbed];
    double least_s = desk.rest[at].known == 2 * desk.plans ? desk.rest[at].remains_s : INFINITY;
    for (const EliminationTree::Arc& arc : tree_.arcs(at))
      least_s = std::min(least_s, arc.there_s + desk.rest[arc.to].remains_s);
    desk.rest[at] = {least_s, 2 * desk.plans + 1};
  }
  return desk.rest[station].remains_s;
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
  way_.reserve(kStretch);
  Desk& desk = Desk::of_this_thread(map_.station_count());
  climb_from(desk, to);
  if (remains_s(desk, from) == INFINITY) return;
  std::uint32_t before = FP_NONE;
  for (std::uint32_t at = from; at != to && way_.size() < kStretch;) {
    const Hop next = quick_hop(desk, before, at, to);
    way_.push_back(next.lane);
    before = std::exchange(at, next.to);
  }
  std::ranges::reverse(way_);
}

// Back to the station before, which lies on the way, is never quick.
QuickestWay::Hop QuickestWay::quick_hop(Desk& desk, std::uint32_t before, std::uint32_t from, std::uint32_t to) const {
  const auto hops = routes_.hops_from(from);
  if (hops.size() == 1) return hops.front();
  const auto is_back = [&](const Hop& hop) { return hop.to == before && times_s_[hop.lane] > kSurelyTakes_s; };
  if (hops.size() == 2 && is_back(hops[0])) return hops[1];
  if (hops.size() == 2 && is_back(hops[1])) return hops[0];
  const double all_s = remains_s(desk, from);
  Hop next{FP_NONE, FP_NONE};
  std::uint32_t quick = 0;
  for (const Hop& hop : hops) {
    if (is_back(hop) || !is_quick(times_s_[hop.lane] + remains_s(desk, hop.to), all_s)) continue;
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
  const double all_s = remains_s(desk, from);
  desk.known_forward(from).cost_s = 0.0;
  push(desk.open, {0.0, from});
  while (!desk.open.empty()) {
    const auto [so_far_s, here] = pop(desk.open);
    if (here == to) break;
    if (so_far_s > desk.known_forward(here).cost_s) continue;
    for (const auto& [lane, end] : routes_.hops_from(here)) {
      const double sum_s = so_far_s + times_s_[lane];
      if (!is_quick(sum_s + remains_s(desk, end), all_s)) continue;
      Desk::Reached& known = desk.known_forward(end);
      if (sum_s >= known.cost_s) continue;
      known.cost_s = sum_s;
      known.arrival = lane;
      push(desk.open, {sum_s, end});
    }
  }
  std::uint32_t first = desk.known_forward(to).arrival;
  while (map_.lane(first).from != from) first = desk.known_forward(map_.lane(first).from).arrival;
  return first;
}

}  // namespace fleetproof::agents
