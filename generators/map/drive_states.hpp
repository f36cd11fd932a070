#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/scenario/lane_rules.hpp"
#include "generators/map/strong_components.hpp"

namespace fleetproof {

// Where an AGV of one type can get on a map with rules, with a load and without one. How it may go on depends on the
// lane by which it has come; with one load, it goes from lane to lane.
class DriveStates {
 public:
  // `vehicle_type` as in LaneRules. Requires: the map outlives the object.
  DriveStates(const LogicalMap& map, std::string vehicle_type);

  // Whether an AGV that leaves by this lane, empty, can go on for ever and come back.
  bool in_core(std::uint32_t lane) const { return is_core(lane, false); }
  // The stations to which and from which an AGV can bring a load, and can come and go without one.
  std::vector<bool> stations_in_core() const;
  // Whether some lane that leaves `from` begins a way to `to`, with a load and without one.
  bool reaches(StationId from, StationId to) const;

 private:
  LaneRules rules(bool loaded) const { return {*map_, vehicle_type_, loaded}; }
  bool permits(std::uint32_t lane, bool loaded) const;
  bool is_core(std::uint32_t lane, bool loaded) const;
  // Calls `visit` with each lane by which an AGV that has come by `lane` may go on.
  template <class Visit>
  void for_each_next(std::uint32_t lane, bool loaded, const Visit& visit) const;
  StrongComponents parts(bool loaded) const;
  bool goes_on_in_core(std::uint32_t lane, bool loaded) const;
  bool reaches(StationId from, StationId to, bool loaded) const;

  const LogicalMap* map_;
  std::string vehicle_type_;
  std::array<StrongComponents, 2> parts_;  // of lanes: without a load, with one
};

}  // namespace fleetproof
