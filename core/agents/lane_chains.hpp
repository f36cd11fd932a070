#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/map_view.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// Most stations of a plant have two neighbours, and lanes that lead on from one to the other, in one direction or in
// both. Such stations form chains. No quickest way turns round in a chain: it enters at one end and leaves at the
// other. A search that knows the chains looks at their ends only.
struct ChainPlace {
  // The two stations at which the chain ends, and the time along the chain to each of them and from it; infinite
  // where the lanes lead the other way. Of a station that is in no chain: the station itself, and nothing.
  std::array<std::uint32_t, 2> end{FP_NONE, FP_NONE};
  std::array<double, 2> to_end_s{INFINITY, INFINITY}, from_end_s{INFINITY, INFINITY};
  std::uint32_t chain = FP_NONE;  // the lane by which it is entered from the first end; FP_NONE: it is in none

  bool is_inside() const { return chain != FP_NONE; }
};

// A lane between stations that are in no chain, or a chain.
struct ChainArc {
  std::uint32_t from, to;
  double time_s;
};

struct LaneChains {
  std::vector<ChainPlace> places;  // by station
  std::vector<ChainArc> arcs;

  // `times_s`: by lane.
  LaneChains(const MapView& map, std::span<const double> times_s);

 private:
  void follow(const MapView& map, std::span<const double> times_s, std::uint32_t first);

  std::vector<std::uint8_t> may_be_inside_;  // by station
};

}  // namespace fleetproof::agents
