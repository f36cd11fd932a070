#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

// The cost of the cheapest way from one station to each other one, or from each other one to it. Many searches follow,
// so this copies what they read from the map into one table: lanes of the map are large.
class LeastCosts {
 public:
  // `lane_costs`: by lane, none below 0; infinite where nobody must drive. `back`: the ways end where they would begin.
  LeastCosts(const MapView& map, std::span<const double> lane_costs, bool back);
  // From the bytes of another one; they outlive it.
  explicit LeastCosts(std::span<const std::byte> bytes);
  LeastCosts(const LeastCosts&) = delete;
  LeastCosts& operator=(const LeastCosts&) = delete;

  std::vector<std::byte> bytes() const;
  // By station; infinite where there is no way.
  std::vector<double> from(std::uint32_t station) const;

 private:
  struct Step {
    double cost;
    std::uint32_t to;
    std::uint32_t is_dead_end;  // from there, one can only come back
  };
  struct Search;

  void mark_dead_ends();

  std::vector<Step> own_steps_;
  std::vector<std::uint32_t> own_first_;
  std::span<const Step> steps_;           // by the station that they leave
  std::span<const std::uint32_t> first_;  // by station, and one more
  double width_ = 1.0;                    // few stations lie within it
};

}  // namespace fleetproof::agents
