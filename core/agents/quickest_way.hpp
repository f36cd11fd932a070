#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/lane_chains.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/routes.hpp"

namespace fleetproof::agents {

// The next lane of the quickest way to a station, asked for again at every station of the way. It is the lane with
// which the way of Routes::search begins, but most answers need no search:
// * One search from the goal backwards, at the first question, gives the time that remains from every station that can
//   lie on a quickest way. It looks towards the AGV first: landmarks bound the time to each station from below.
// * Only one lane of most stations leaves that time unchanged. If several do, a search forward along such lanes decides
//   as Routes::search does.
// * The whole way is written down at once, so that nothing of the search has to be kept.
// Not for plants with rules. Requires: facts, map and routes outlive it.
class QuickestWay {
 public:
  QuickestWay(const fp_facts& facts, const MapView& map, const Routes& routes, std::uint32_t agv);

  // FP_NONE: there is no way. Requires: the stations differ.
  std::uint32_t next_lane(std::uint32_t from, std::uint32_t to);

  // A lane or a chain. They lie side by side: the lanes of the map are too far apart in memory for a search.
  struct Step {
    double time_s;
    std::uint32_t to;
  };
  static constexpr std::uint32_t kLandmarks = 4;

 private:
  struct Desk;
  using Hop = Routes::Hop;
  // What the landmarks know of the station where a way begins: the time from each, and to it below zero.
  using Bound = std::array<double, 2 * kLandmarks>;

  void plan(std::uint32_t from, std::uint32_t to);
  Bound bound_from(std::uint32_t station) const;
  double landmark_s(std::uint32_t column, std::uint32_t station) const;
  double least_s(const Bound& bound, std::uint32_t station) const;
  void search_back(Desk& desk, std::uint32_t from, std::uint32_t to) const;
  double along_chain_s(std::uint32_t from, std::uint32_t to) const;
  double remains_s(const Desk& desk, std::uint32_t station, std::uint32_t to) const;
  Hop quick_hop(Desk& desk, std::uint32_t before, std::uint32_t from, std::uint32_t to) const;
  std::uint32_t search_forward(Desk& desk, std::uint32_t from, std::uint32_t to) const;

  const MapView& map_;
  const Routes& routes_;
  std::span<const double> times_s_;              // by lane
  double width_s_;                               // of the queue of a search backward
  std::span<const Step> steps_back_;             // by station where they end
  std::span<const std::uint32_t> first_steps_;   // by station, and one more
  std::span<const ChainPlace> places_;           // by station
  std::span<const double> landmarks_s_;          // by station: from each landmark, and to it below zero
  bool has_landmarks_;                           // else the map is small
  std::uint32_t goal_ = FP_NONE, at_ = FP_NONE;  // of the last answer, and the station to which it leads
  std::vector<std::uint32_t> way_;               // the lanes from there on, the last first
};

}  // namespace fleetproof::agents
