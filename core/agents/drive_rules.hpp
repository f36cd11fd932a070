#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

// What the plant allows a vehicle type: permissions, and stations where no AGV turns or where it must stay with one
// heading. Requires: the map outlives the object.
class DriveRules {
 public:
  DriveRules(const MapView& map, std::uint32_t vehicle_type);
  DriveRules(const DriveRules&) = delete;
  DriveRules& operator=(const DriveRules&) = delete;

  // False for most plants: then everything below is allowed.
  bool any() const { return !usable_.empty(); }
  // Whether the AGV may drive the lane, with a load or without one, and can come back to where it was.
  bool is_usable(std::uint32_t lane, bool loaded) const { return !any() || (what(lane, loaded) & kUsable) != 0; }
  // Whether it also gets to the part of the map through which most ways with this load lead, without a pick or drop.
  bool leads_back(std::uint32_t lane, bool loaded) const { return !any() || what(lane, loaded) == kLeadsBack; }
  // Whether an AGV with this heading may leave by this lane.
  bool may_leave(Vec heading, std::uint32_t lane) const {
    return !any() || map_.may_turn(map_.lane(lane).from) || same_heading(heading, map_.start_heading(lane));
  }

 private:
  // A state is the lane by which the AGV has come, and whether it now carries a load: 2 * lane + loaded.
  using States = std::vector<std::uint8_t>;
  enum What : std::uint8_t { kUsable = 1, kLeadsBack = 3 };

  struct WorkOut {};
  DriveRules(const MapView& map, std::uint32_t vehicle_type, WorkOut);

  bool has_rules() const;
  std::uint8_t what(std::uint32_t lane, bool loaded) const { return usable_[2 * lane + (loaded ? 1 : 0)]; }
  bool permits(std::uint32_t state) const { return map_.permits(state / 2, vehicle_type_, state % 2 == 1); }
  bool leads_to(std::uint32_t state, std::uint32_t next) const;
  States connected(std::uint32_t from, bool backwards, bool transfers) const;
  void keep_those_that_lead_back();
  void mark_those_that_lead_back(bool loaded);

  const MapView& map_;
  std::uint32_t vehicle_type_;
  States own_;                            // What, by state, if it is not shared
  std::span<const std::uint8_t> usable_;  // What, by state; empty: no rules
};

}  // namespace fleetproof::agents
