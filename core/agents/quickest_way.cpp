#include "core/agents/quickest_way.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/agents/facts.hpp"
#include "core/agents/lane_costs.hpp"

namespace fleetproof::agents {
namespace {

// More neighbours are allowed as soon as a round takes out no more than one station in so many.
constexpr std::size_t kFew = 16;
constexpr std::size_t kLinksOfALane = 3;  // mostly enough

}  // namespace

class EliminationTree::Elimination {
 public:
  Elimination(const MapView& map, std::span<const double> times_s)
      : stations_(map.station_count()), links_(kLinksOfALane * map.lane_count()) {
    arcs.reserve(2 * std::size_t{map.lane_count()});
    for (std::uint32_t id = 0; id < map.lane_count(); ++id) {
      const fp_lane& lane = map.lane(id);
      if (lane.from != lane.to) connect(lane.from, lane.to, times_s[id], INFINITY);
    }
  }

  // In rounds. A round passes over the neighbours of stations that it has taken out: the tree stays low.
  void run() {
    std::vector<std::uint32_t> left(stations_.size()), later;
    for (std::uint32_t station = 0; station < left.size(); ++station) left[station] = station;
    std::uint32_t most_neighbours = 2;
    for (std::uint32_t round = 1; !left.empty(); ++round, left.swap(later)) {
      later.clear();
      for (const std::uint32_t station : left) {
        const Station& here = stations_[station];
        if (here.passed_over == round || here.neighbours > most_neighbours) {
          later.push_back(station);
        } else {
          take_out(station, round);
        }
      }
      if (kFew * (left.size() - later.size()) <= left.size()) ++most_neighbours;
    }
  }

  std::vector<Node> nodes() const {
    std::vector<Node> nodes;
    nodes.reserve(stations_.size());
    for (const Station& station : stations_)
      nodes.push_back({parent_of(station), station.first_arc, station.neighbours});
    return nodes;
  }

  std::vector<Arc> arcs;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Station {
    std::uint32_t link = kNone;  // the first of the list of its neighbours
    std::uint32_t neighbours = 0;
    std::uint32_t passed_over = 0;    // in this round, or before
    std::uint32_t first_arc = kNone;  // of those that it had when it was taken out
  };
  // From one of two neighbours to the other; the way back stands beside it, at an odd place or at an even one.
  struct Link {
    Arc arc;
    std::uint32_t next;
  };

  void connect(std::uint32_t from, std::uint32_t to, double there_s, double back_s) {
    const std::uint32_t i = link_between(from, to);
    if (i == kNone) return add(from, to, there_s, back_s);
    Arc &there = links_[i].arc, &back = links_[i ^ 1].arc;
    there.there_s = back.back_s = std::min(there.there_s, there_s);
    there.back_s = back.there_s = std::min(there.back_s, back_s);
  }

  std::uint32_t link_between(std::uint32_t from, std::uint32_t to) const {
    std::uint32_t i = stations_[from].link;
    while (i != kNone && links_[i].arc.to != to) i = links_[i].next;
    return i;
  }

  void add(std::uint32_t from, std::uint32_t to, double there_s, double back_s) {
    const std::uint32_t there = link_count_, back = there + 1;
    link_count_ += 2;
    if (link_count_ > links_.size()) links_.resize(2 * link_count_);
    links_[there] = {{there_s, back_s, to}, std::exchange(stations_[from].link, there)};
    links_[back] = {{back_s, there_s, from}, std::exchange(stations_[to].link, back)};
    ++stations_[from].neighbours, ++stations_[to].neighbours;
  }

  void unlink(std::uint32_t from, std::uint32_t to) {
    std::uint32_t* place = &stations_[from].link;
    while (links_[*place].arc.to != to) place = &links_[*place].next;
    *place = links_[*place].next;
    --stations_[from].neighbours;
  }

  void take_out(std::uint32_t id, std::uint32_t round) {
    const auto first = static_cast<std::uint32_t>(arcs.size());
    stations_[id].first_arc = first;
    for (std::uint32_t i = stations_[id].link; i != kNone; i = links_[i].next) {
      arcs.push_back(links_[i].arc);
      unlink(links_[i].arc.to, id);
      stations_[links_[i].arc.to].passed_over = round;
    }
    const auto neighbours = std::span(arcs).subspan(first);
    for (std::size_t i = 1; i < neighbours.size(); ++i) {
      const Arc& one = neighbours[i];
      for (const Arc& other : neighbours.first(i))
        connect(one.to, other.to, one.back_s + other.there_s, other.back_s + one.there_s);
    }
  }

  // Arcs are written in the order in which stations are taken out.
  std::uint32_t parent_of(const Station& station) const {
    std::uint32_t parent = FP_NONE;
    for (std::uint32_t i = 0; i < station.neighbours; ++i) {
      const std::uint32_t to = arcs[station.first_arc + i].to;
      if (parent == FP_NONE || stations_[to].first_arc < stations_[parent].first_arc) parent = to;
    }
    return parent;
  }

  std::vector<Station> stations_;
  std::vector<Link> links_;  // the first link_count_
  std::uint32_t link_count_ = 0;
};

std::vector<std::byte> EliminationTree::bytes(const MapView& map, std::span<const double> times_s) {
  Elimination elimination(map, times_s);
  elimination.run();
  TableWriter tables;
  tables.add(elimination.nodes(), elimination.arcs);
  return tables.bytes();
}

EliminationTree::EliminationTree(std::span<const std::byte> bytes) {
  TableReader tables(bytes);
  nodes_ = tables.next<Node>();
  arcs_ = tables.next<Arc>();
}

namespace {

// Sums of the same times in another order differ by less.
constexpr double kRounding = 1e-9;
constexpr std::size_t kLanesAtOnce = 16;  // many an AGV stops, or the run, before it has driven more
constexpr double kSurelyTakes_s = 1e-3;   // more than rounding, on any way of less than a week

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
struct QuickestWay::Workspace {
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

  static Workspace& of_this_thread(std::uint32_t station_count) {
    thread_local Workspace workspace;
    if (workspace.rest.size() >= station_count) return workspace;
    workspace.rest.resize(station_count), workspace.reached.resize(station_count),
        workspace.climb.resize(station_count);
    return workspace;
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
void QuickestWay::climb_from(Workspace& workspace, std::uint32_t goal) const {
  ++workspace.plans;
  for (std::uint32_t at = goal; at != FP_NONE; at = tree_.parent(at))
    workspace.rest[at] = {INFINITY, 2 * workspace.plans};
  workspace.rest[goal].remains_s = 0.0;
  for (std::uint32_t at = goal; at != FP_NONE; at = tree_.parent(at)) {
    const double so_far_s = workspace.rest[at].remains_s;
    for (const EliminationTree::Arc& arc : tree_.arcs(at)) {
      double& remains_s = workspace.rest[arc.to].remains_s;
      remains_s = std::min(remains_s, so_far_s + arc.back_s);
    }
  }
}

// Infinite if there is no way. Ways that climb first go on as the quickest way of an ancestor.
double QuickestWay::remains_s(Workspace& workspace, std::uint32_t station) const {
  std::size_t climbed = 0;
  for (std::uint32_t at = station; at != FP_NONE && !workspace.is_settled(at); at = tree_.parent(at))
    workspace.climb[climbed++] = at;
  while (climbed > 0) {
    const std::uint32_t at = workspace.climb[--climbed];
    double least_s = workspace.rest[at].known == 2 * workspace.plans ? workspace.rest[at].remains_s : INFINITY;
    for (const EliminationTree::Arc& arc : tree_.arcs(at))
      least_s = std::min(least_s, arc.there_s + workspace.rest[arc.to].remains_s);
    workspace.rest[at] = {least_s, 2 * workspace.plans + 1};
  }
  return workspace.rest[station].remains_s;
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
  way_.reserve(kLanesAtOnce);
  Workspace& workspace = Workspace::of_this_thread(map_.station_count());
  climb_from(workspace, to);
  if (remains_s(workspace, from) == INFINITY) return;
  std::uint32_t before = FP_NONE;
  for (std::uint32_t at = from; at != to && way_.size() < kLanesAtOnce;) {
    const Hop next = quick_hop(workspace, before, at, to);
    way_.push_back(next.lane);
    before = std::exchange(at, next.to);
  }
  std::ranges::reverse(way_);
}

// Back to the station before, which lies on the way, is never quick.
QuickestWay::Hop QuickestWay::quick_hop(Workspace& workspace, std::uint32_t before, std::uint32_t from,
                                        std::uint32_t to) const {
  const auto hops = routes_.hops_from(from);
  if (hops.size() == 1) return hops.front();
  const auto is_back = [&](const Hop& hop) { return hop.to == before && times_s_[hop.lane] > kSurelyTakes_s; };
  if (hops.size() == 2 && is_back(hops[0])) return hops[1];
  if (hops.size() == 2 && is_back(hops[1])) return hops[0];
  const double all_s = remains_s(workspace, from);
  Hop next{FP_NONE, FP_NONE};
  std::uint32_t quick = 0;
  for (const Hop& hop : hops) {
    if (is_back(hop) || !is_quick(times_s_[hop.lane] + remains_s(workspace, hop.to), all_s)) continue;
    next = hop;
    ++quick;
  }
  if (quick <= 1) return next;
  const std::uint32_t lane = search_forward(workspace, from, to);
  return {lane, map_.lane(lane).to};
}

// The search of Routes::search, but only over stations that lie on a quickest way. Other stations cannot change
// the result: no way through them reaches a station of a quickest way at so small a cost.
std::uint32_t QuickestWay::search_forward(Workspace& workspace, std::uint32_t from, std::uint32_t to) const {
  workspace.begin_forward();
  const double all_s = remains_s(workspace, from);
  workspace.known_forward(from).cost_s = 0.0;
  push(workspace.open, {0.0, from});
  while (!workspace.open.empty()) {
    const auto [so_far_s, here] = pop(workspace.open);
    if (here == to) break;
    if (so_far_s > workspace.known_forward(here).cost_s) continue;
    for (const auto& [lane, end] : routes_.hops_from(here)) {
      const double sum_s = so_far_s + times_s_[lane];
      if (!is_quick(sum_s + remains_s(workspace, end), all_s)) continue;
      Workspace::Reached& known = workspace.known_forward(end);
      if (sum_s >= known.cost_s) continue;
      known.cost_s = sum_s;
      known.arrival = lane;
      push(workspace.open, {sum_s, end});
    }
  }
  std::uint32_t first = workspace.known_forward(to).arrival;
  while (map_.lane(first).from != from) first = workspace.known_forward(map_.lane(first).from).arrival;
  return first;
}

}  // namespace fleetproof::agents
