#include "core/agents/elimination_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/agents/facts.hpp"

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

}  // namespace fleetproof::agents
