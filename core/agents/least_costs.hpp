#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

// The cost of the cheapest way from one station to each other one, or from each other one to it. Many searches follow,
// so the steps between stations are put side by side: lanes of the map are large. Most stations have one way on. They
// are written down as runs from one station where ways branch to the next, dead ends beside them included, and a search
// queues nothing within a run.
class LeastCosts {
 public:
  // `lane_costs`: by lane, none below 0; infinite where nobody must drive. `back`: the ways end where they would begin.
  LeastCosts(const MapView& map, std::span<const double> lane_costs, bool back);
  // From the bytes of another one; they outlive it.
  explicit LeastCosts(std::span<const std::byte> bytes);
  LeastCosts(const LeastCosts&) = delete;
  LeastCosts& operator=(const LeastCosts&) = delete;

  // Requires: it was made from a map, and the lane had a finite cost, as it has now.
  void change(std::uint32_t lane, double cost) { own_steps_[step_of_lane_[lane]].cost = cost; }
  std::vector<std::byte> bytes() const;
  // By station; infinite where there is no way.
  std::vector<double> from(std::uint32_t station) const;

 private:
  struct Step {
    double cost;
    std::uint32_t to;
    std::uint32_t is_dead_end;  // from there, one can only come back
  };
  // A step and the steps after it, as long as one way leads on. Then `branches` says whether several do.
  struct Run {
    std::uint32_t first = 0, end = 0, branches = 0;
    bool is_written() const { return first != end; }
  };

  void mark_dead_ends();
  void write_runs();
  bool branches(std::uint32_t before, std::uint32_t station) const;
  // Appends the steps.
  Run follow(std::uint32_t from, std::uint32_t step, std::vector<std::uint32_t>& steps) const;

  std::vector<Step> own_steps_;
  std::vector<std::uint32_t> own_first_, own_run_steps_, step_of_lane_;
  std::vector<Run> own_runs_;
  std::span<const Step> steps_;           // by the station that they leave
  std::span<const std::uint32_t> first_;  // by station, and one more
  std::span<const Run> runs_;             // by step; written for stations where ways branch
  std::span<const std::uint32_t> run_steps_;
  double width_ = 1.0;  // few stations lie within it
};

}  // namespace fleetproof::agents
