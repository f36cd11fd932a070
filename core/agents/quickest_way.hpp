#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/elimination_tree.hpp"
#include "core/agents/facts.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/routes.hpp"

namespace fleetproof::agents {

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
  struct Desk;
  using Hop = Routes::Hop;

  void plan(std::uint32_t from, std::uint32_t to);
  void climb_from(Desk& desk, std::uint32_t goal) const;
  double remains_s(Desk& desk, std::uint32_t station) const;
  Hop quick_hop(Desk& desk, std::uint32_t before, std::uint32_t from, std::uint32_t to) const;
  std::uint32_t search_forward(Desk& desk, std::uint32_t from, std::uint32_t to) const;

  const MapView& map_;
  const Routes& routes_;
  std::span<const double> times_s_;  // by lane
  EliminationTree tree_;
  std::uint32_t goal_ = FP_NONE, at_ = FP_NONE;  // of the last answer, and the station to which it leads
  std::vector<std::uint32_t> way_;               // the lanes from there on, the last first
};

}  // namespace fleetproof::agents
