#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/map/drive_states.hpp"

namespace fleetproof {

// Which stations of a logical map can be reached from which, under the rules of the plant. `type` is the place of a
// vehicle type among those of the fleet. Requires: the map outlives the object.
class Reachability {
 public:
  // For a fleet of vehicle types with these names; without a name, of one type that has the permissions of all.
  explicit Reachability(const LogicalMap& map, std::span<const std::string> vehicle_types = {});

  // The largest set of stations that can all reach each other, in ascending order. Of equal sets, the set with the
  // smallest id. Under rules: the stations to which AGVs of some type come again and again, with a load or without.
  const std::vector<StationId>& core() const { return core_; }
  bool in_core(StationId station) const { return in_core_[station.index()]; }
  double core_share() const { return static_cast<double>(core_.size()) / static_cast<double>(in_core_.size()); }
  // Those of the core where an AGV of some type can start.
  const std::vector<StationId>& starts() const { return starts_; }
  // What AGVs of this type can do there; without rules, everything in the core.
  const StationUse& use_of(StationId station, std::uint32_t type = 0) const { return uses_[of(type)][station.index()]; }
  bool reaches(StationId from, StationId to, bool loaded, std::uint32_t type = 0) const;
  // Whether every load that is picked somewhere can be dropped wherever one can.
  bool carries_all(std::uint32_t type) const { return states_.empty() || states_[type].carries_all(); }
  // Where a load that is picked at `from` can be dropped, by station. Requires: the plant has rules.
  std::vector<bool> carried_from(StationId from, std::uint32_t type) const { return states_[type].carried_from(from); }
  // Whether the plant lets an AGV of this type drive the lane.
  bool permits(std::uint32_t lane, bool loaded, std::uint32_t type) const;
  // Whether an AGV that stands at the beginning of the lane can leave by it, and come back.
  bool may_start_along(std::uint32_t lane, std::uint32_t type) const;

 private:
  std::size_t of(std::uint32_t type) const { return states_.empty() ? 0 : type; }
  bool reaches_without_rules(StationId from, StationId to) const;

  const LogicalMap* map_;
  std::vector<DriveStates> states_;            // by vehicle type; none: the plant has no rules
  std::vector<std::vector<StationUse>> uses_;  // by vehicle type, one without rules; then by station
  std::vector<bool> in_core_;                  // by station
  std::vector<StationId> core_, starts_;
};

}  // namespace fleetproof
