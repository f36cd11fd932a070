#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/clearance/sweep.hpp"
#include "core/scenario/scenario.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// Which lanes and stations conflict for which vehicles: the answers of fp_host::conflict, worked out when they are
// asked for, and kept. Threads: one at a time.
class LaneConflicts {
 public:
  explicit LaneConflicts(const Scenario& scenario);

  // Whether the answers are those for this scenario, of the same map.
  bool fits(const Scenario& scenario) const;
  // Nothing if an argument is wrong.
  std::optional<bool> answer(const fp_occupancy& a, const fp_occupancy& b, double margin_m);

 private:
  // What one occupancy covers: all that its answers depend on.
  using Key = std::array<std::uint64_t, 4>;
  std::optional<Key> key_of(const fp_occupancy& occupancy) const;
  const Sweep& sweep_of(const Key& key, const fp_occupancy& occupancy);
  Sweep make_sweep(const fp_occupancy& occupancy) const;

  std::shared_ptr<const LogicalMap> map_;
  std::vector<std::array<Footprint, 3>> footprints_;  // by vehicle type, then by fp_load_state
  double safety_distance_m_;
  std::map<Key, Sweep> sweeps_;
  std::map<std::array<Key, 2>, bool> answers_;  // of one margin
  double margin_m_ = 0.0;
};

}  // namespace fleetproof
