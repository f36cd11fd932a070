#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/map/drive_states.hpp"

namespace fleetproof {

// Which stations of a logical map can be reached from which, under the rules of the plant. Requires: the map outlives
// the object.
class Reachability {
 public:
  // For a fleet of vehicle types with these names; without a name, of one type that has the permissions of all.
  explicit Reachability(const LogicalMap& map, std::span<const std::string> vehicle_types = {});

  // The largest set of stations that can all reach each other, in ascending order. Of equal sets, the set with the
  // smallest id. Under rules: the stations to which AGVs of every type come again and again, with a load or without.
  const std::vector<StationId>& core() const { return core_; }
  // Those of the core where an AGV without a load can stop.
  const std::vector<StationId>& stops() const { return stops_; }
  bool in_core(StationId station) const { return use_of(station).passed; }
  double core_share() const { return static_cast<double>(core_.size()) / static_cast<double>(uses_.size()); }
  // What AGVs of every type can do there; without rules, everything in the core.
  const StationUse& use_of(StationId station) const { return uses_[station.index()]; }
  bool reaches(StationId from, StationId to, bool loaded) const;
  // Whether an AGV that stands at the beginning of the lane can leave by it, and come back.
  bool may_start_along(std::uint32_t lane) const;

 private:
  bool reaches_without_rules(StationId from, StationId to) const;

  const LogicalMap* map_;
  std::vector<DriveStates> states_;  // by vehicle type; none: the plant has no rules
  std::vector<StationUse> uses_;     // by station
  std::vector<StationId> core_, stops_;
};

}  // namespace fleetproof
