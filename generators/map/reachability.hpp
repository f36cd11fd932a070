#pragma once

#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/map/strong_components.hpp"

namespace fleetproof {

// Which stations of a logical map can be reached from which. Requires: the map outlives the object.
class Reachability {
 public:
  explicit Reachability(const LogicalMap& map);

  // The largest set of stations that can all reach each other, in ascending order. Of equal sets, the set with the
  // smallest id.
  const std::vector<StationId>& core() const { return core_; }
  bool in_core(StationId station) const { return parts_.in_largest(station.index()); }
  double core_share() const { return static_cast<double>(core_.size()) / static_cast<double>(parts_.component.size()); }
  bool reaches(StationId from, StationId to) const;

 private:
  const LogicalMap* map_;
  StrongComponents parts_;  // of stations
  std::vector<StationId> core_;
};

}  // namespace fleetproof
