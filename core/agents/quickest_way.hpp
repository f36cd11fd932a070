// The next lane of a quickest way. A tree of separators answers most questions without a search.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/routes.hpp"

namespace fleetproof::agents {

// Tells the time of the quickest way between two stations without a search. The stations are taken out of the map one
// after the other, those with few neighbours first. When a station is taken out, its neighbours become neighbours of
// each other: arcs between them stand for the ways through it. For every way, there is one as quick that first climbs
// along arcs to stations that are taken out later and later, and then descends.
// Of its neighbours at that time, the one that goes first is the parent of the station, and the others are ancestors of
// the parent. So all that can be reached by climbing are the ancestors of one station: in a plant, 40 to 60 of 7 500
// stations. (Customizable contraction hierarchies: Dibbelt, Strasser, Wagner 2016.)
class EliminationTree {
 public:
  // To an ancestor, and back from there; infinite where there is no way.
  struct Arc {
    double there_s, back_s;
    std::uint32_t to;
  };

  // `times_s`: by lane.
  static std::vector<std::byte> bytes(const MapView& map, std::span<const double> times_s);
  // From such bytes, which outlive it.
  explicit EliminationTree(std::span<const std::byte> bytes);

  // FP_NONE: it is a root. A map that is not connected has several.
  std::uint32_t parent(std::uint32_t station) const { return nodes_[station].parent; }
  std::span<const Arc> arcs(std::uint32_t station) const {
    return arcs_.subspan(nodes_[station].first, nodes_[station].count);
  }

 private:
  class Elimination;
  struct Node {
    std::uint32_t parent, first, count;  // arcs
  };

  std::span<const Node> nodes_;  // by station
  std::span<const Arc> arcs_;
};

// The next lane of the quickest way to a station, asked for again at every station of the way. It is the lane with
// which the way of Routes::search begins, but most answers need no search:
// * The elimination tree of the map gives the time that remains from a station to the goal.
// * Only one lane of most stations leaves that time unchanged. If several do, a search forward along such lanes decides
//   as Routes::search does.
// * The whole way is written down at once, so that nothing that was found out has to be kept.
// Not for plants with rules. Requires: facts, map and routes outlive it.
class QuickestWay {
 public:
  QuickestWay(const fp_facts& facts, const MapView& map, const Routes& routes, std::uint32_t agv);

  // FP_NONE: there is no way. Requires: the stations differ.
  std::uint32_t next_lane(std::uint32_t from, std::uint32_t to);

 private:
  struct Workspace;
  using Hop = Routes::Hop;

  void plan(std::uint32_t from, std::uint32_t to);
  void climb_from(Workspace& workspace, std::uint32_t goal) const;
  double remains_s(Workspace& workspace, std::uint32_t station) const;
  Hop quick_hop(Workspace& workspace, std::uint32_t before, std::uint32_t from, std::uint32_t to) const;
  std::uint32_t search_forward(Workspace& workspace, std::uint32_t from, std::uint32_t to) const;

  const MapView& map_;
  const Routes& routes_;
  std::span<const double> times_s_;  // by lane
  EliminationTree tree_;
  std::uint32_t goal_ = FP_NONE, at_ = FP_NONE;  // of the last answer, and the station to which it leads
  std::vector<std::uint32_t> way_;               // the lanes from there on, the last first
};

}  // namespace fleetproof::agents
