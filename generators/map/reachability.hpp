// Which stations an AGV can reach and leave again, heading included.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/scenario/lane_rules.hpp"
#include "core/scenario/layout.hpp"
#include "generators/map/strong_components.hpp"

namespace fleetproof {

// What AGVs can do at a station and then go on, for ever, by whichever lane they come.
struct StationUse {
  bool passed = false;   // come, and go on, perhaps after a pick or drop
  bool started = false;  // start there without a load
  bool stopped = false;  // come without a load, stand there as the station asks, and go on without one
  bool picks = false;    // come without a load, pick one, and go on with it
  bool drops = false;    // come with a load, drop it, and go on without one
};
inline constexpr StationUse kEveryUse{true, true, true, true, true};

// Where an AGV of one type can get on a map with rules, with a load and without one. How it may go on depends on the
// lane by which it has come; a load is picked and dropped at stations. From every station where AGVs start, stop or
// drop, a way without a load leads to every station where they pick or stop. carried_from() says where loads get.
class DriveStates {
 public:
  // `vehicle_type` as in LaneRules. Requires: the map outlives the object.
  DriveStates(const LogicalMap& map, std::string vehicle_type);

  // Whether an AGV that leaves by this lane, empty, gets to all stations where AGVs pick or stop.
  bool may_start_along(std::uint32_t lane) const;
  bool permits(std::uint32_t lane, bool loaded) const { return traffic_[loaded].permitted[lane]; }
  const std::vector<StationUse>& uses() const { return uses_; }  // by station
  // Whether every load that AGVs pick can be dropped at every station where they drop.
  bool carries_all() const { return carries_all_; }
  // Where a load that is picked at `from` can be dropped, by station.
  std::vector<bool> carried_from(StationId from) const;
  // Whether a way leads from one station to the other, where the AGV may stop; it may be a trap.
  bool reaches(StationId from, StationId to, bool loaded) const;

 private:
  // Of AGVs with a load, or of those without one, by the lane at whose end they are.
  struct Traffic {
    std::vector<bool> permitted;
    // "There" is a station, or lanes that all lead to each other: the part of the map through which most ways lead.
    std::vector<bool> comes_from_there, leads_there;
  };

  // At the end of a lane, with a load or without one. It may have been picked or dropped there.
  static std::uint32_t state(std::uint32_t lane, bool loaded) { return 2 * lane + (loaded ? 1 : 0); }

  LaneRules rules(bool loaded) const { return {*map_, vehicle_type_, loaded}; }
  bool stops_after(std::uint32_t lane) const;
  // Calls `visit` with each lane by which an AGV that has come by `lane` may go on.
  template <class Visit>
  void for_each_next(std::uint32_t lane, bool loaded, const Visit& visit) const;
  std::vector<Arrow> onward(bool loaded) const;
  void find_states_for_ever();
  void find_ways(bool loaded);
  void find_uses();
  // The lanes that an AGV can drive which begins with one of `first`; if `among` is given, only through these states.
  std::vector<bool> driven_from(const std::vector<std::uint32_t>& first, bool loaded,
                                const std::vector<bool>* among) const;

  const LogicalMap* map_;
  std::string vehicle_type_;
  std::array<Traffic, 2> traffic_;  // without a load, with one
  std::vector<StationUse> uses_;    // by station
  std::vector<bool> for_ever_;      // by state: whether AGVs come into it again and again
  bool carries_all_ = false;
};

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
