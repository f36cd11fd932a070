#pragma once

#include <cstdint>
#include <vector>

#include "core/layout.hpp"

namespace fleetproof {

// Who can drive where on a logical map. Refers to the map, which outlives it.
class Reachability {
 public:
  explicit Reachability(const LogicalMap& map);

  // The largest set of stations that can all reach each other, by ascending id; the one with the smallest id among equals.
  const std::vector<StationId>& core() const { return core_; }
  bool in_core(StationId station) const { return component_[station.index()] == core_component_; }
  double core_share() const { return static_cast<double>(core_.size()) / static_cast<double>(component_.size()); }
  bool reaches(StationId from, StationId to) const;

 private:
  void find_components();

  const LogicalMap* map_;
  std::vector<std::uint32_t> component_;  // by station
  std::uint32_t component_count_ = 0, core_component_ = 0;
  std::vector<StationId> core_;
};

}  // namespace fleetproof
