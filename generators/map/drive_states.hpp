#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/scenario/lane_rules.hpp"
#include "generators/map/strong_components.hpp"

namespace fleetproof {

// What AGVs can do at a station and then go on, for ever.
struct StationUse {
  bool passed = false;   // come, and go on, perhaps after a pick or drop
  bool stopped = false;  // come without a load, stand there as the station asks, and go on without one
  bool picks = false;    // come without a load, pick one, and go on with it
  bool drops = false;    // come with a load, drop it, and go on without one
};
inline constexpr StationUse kEveryUse{true, true, true, true};

// Where an AGV of one type can get on a map with rules, with a load and without one. How it may go on depends on the
// lane by which it has come; a load is picked and dropped at stations. From every station where AGVs pick, a way leads
// to every station where they drop; from there, without a load, to every station where they pick or stop.
class DriveStates {
 public:
  // `vehicle_type` as in LaneRules. Requires: the map outlives the object.
  DriveStates(const LogicalMap& map, std::string vehicle_type);

  // Whether an AGV that leaves by this lane, empty, gets to all stations where AGVs pick or stop.
  bool may_start_along(std::uint32_t lane) const {
    return traffic_[0].permitted[lane] && traffic_[0].leads_there[lane];
  }
  bool permits(std::uint32_t lane, bool loaded) const { return traffic_[loaded].permitted[lane]; }
  const std::vector<StationUse>& uses() const { return uses_; }  // by station
  // Whether some lane that leaves `from` begins a way to `to`, where the AGV may stop.
  bool reaches(StationId from, StationId to, bool loaded) const;

 private:
  // Of AGVs with a load, or of those without one, by the lane at whose end they are.
  struct Traffic {
    std::vector<bool> permitted;
    std::vector<Arrow> onward;  // to the lanes that they may drive next
    // "There" is the part of the map through which most ways lead; inside it, every lane leads to every other.
    std::vector<bool> comes_from_there, leads_there;
  };

  // At the end of a lane, with a load or without one. It may have been picked or dropped there.
  static std::uint32_t state(std::uint32_t lane, bool loaded) { return 2 * lane + (loaded ? 1 : 0); }

  LaneRules rules(bool loaded) const { return {*map_, vehicle_type_, loaded}; }
  bool stops_after(std::uint32_t lane) const;
  // Calls `visit` with each lane by which an AGV that has come by `lane` may go on.
  template <class Visit>
  void for_each_next(std::uint32_t lane, bool loaded, const Visit& visit) const;
  std::vector<bool> states_for_ever() const;
  void find_ways(bool loaded, const std::vector<bool>& for_ever);
  void find_uses(const std::vector<bool>& for_ever);

  const LogicalMap* map_;
  std::string vehicle_type_;
  std::array<Traffic, 2> traffic_;  // without a load, with one
  std::vector<StationUse> uses_;    // by station
};

}  // namespace fleetproof
