#pragma once

#include <deque>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "core/sdk/fact_store.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// What each agent gets to know before the run: the map with its geometry, the fleet, the script. This object owns the
// memory that the C structs point into.
class Briefings {
 public:
  // `share_facts`: the agents ask one store for what follows from map and fleet. Else each has its own.
  Briefings(const Scenario& scenario, const char* agent_config, bool share_facts = true);
  Briefings(const Briefings&) = delete;
  Briefings& operator=(const Briefings&) = delete;

  const fp_briefing& of(AgvId agv) const { return briefings_[agv.index()]; }
  // After a restart. `station`: where the AGV stands, or the last station it left. `lane`: the lane that it drives, or
  // null. `next`: the lane that it is going to drive after that, or null.
  void renew(AgvId agv, std::uint32_t boot, StationId station, const Lane* lane, const Lane* next);

 private:
  void describe_permissions(const Scenario& scenario);
  void describe_map(const LogicalMap& map);
  void describe_lane(const LogicalMap& map, const Lane& lane);
  void describe_fleet(const Scenario& scenario);

  std::vector<std::vector<fp_permission>> permissions_;  // by segment
  std::vector<fp_arc> arcs_;
  std::vector<fp_lane> lanes_;
  std::vector<fp_station> stations_;
  std::vector<fp_block> blocks_;
  fp_map map_{};
  std::vector<fp_agv> fleet_;
  std::vector<std::vector<fp_scripted_call>> scripts_;
  std::deque<FactStore> facts_;
  std::vector<fp_briefing> briefings_;
};

}  // namespace fleetproof
