#pragma once

#include <string>
#include <vector>

#include "core/scenario/lane_rules.hpp"
#include "generators/map/strong_components.hpp"

namespace fleetproof {

// Where an AGV of one type can get on a map with rules. A state is the lane by which the AGV has come, and whether it
// carries a load: both decide how it may go on. It takes up and puts down loads where it may stay.
class DriveStates {
 public:
  // `vehicle_type` as in LaneRules. Requires: the map outlives the object.
  DriveStates(const LogicalMap& map, std::string vehicle_type);

  // Whether an AGV that leaves by this lane, empty, can go on for ever and come back.
  bool in_core(std::uint32_t lane) const { return parts_.in_largest(state(lane, false)); }
  // The stations where such an AGV can stay with a load and without one.
  std::vector<bool> stations_in_core() const;
  // Whether some lane that leaves `from` begins a way to `to`.
  bool reaches(StationId from, StationId to) const;

 private:
  static std::uint32_t state(std::uint32_t lane, bool loaded) { return 2 * lane + (loaded ? 1 : 0); }
  const Lane& lane_of(std::uint32_t state) const { return map_->lanes()[state / 2]; }
  LaneRules rules(bool loaded) const { return {*map_, vehicle_type_, loaded}; }
  bool exists(std::uint32_t state) const;
  template <class Visit>
  void for_each_next(std::uint32_t state, const Visit& visit) const;
  std::vector<Arrow> arrows() const;

  const LogicalMap* map_;
  std::string vehicle_type_;
  StrongComponents parts_;  // of states
};

}  // namespace fleetproof
