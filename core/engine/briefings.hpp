#pragma once

#include <memory>
#include <vector>

#include "core/engine/fleet_software.hpp"
#include "core/engine/told_plant.hpp"
#include "core/scenario/scenario.hpp"
#include "core/sdk/fact_store.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof {

// What each agent gets to know before the run: the plant, its own number, start and script. This object owns the memory
// that the C structs point into, except that of the plant.
class Briefings {
 public:
  // `share_facts`: the agents share what they derive from the plant. Else each has a store of its own. Requires: the
  // plant fits the scenario and outlives the object.
  Briefings(const Scenario& scenario, const FleetSoftware& software, const ToldPlant& plant, bool share_facts = true);
  Briefings(const Briefings&) = delete;
  Briefings& operator=(const Briefings&) = delete;

  const fp_briefing& of(EntityId participant) const { return briefings_[participant.index()]; }
  // After a restart. `station`: where the AGV stands, or the last station it left. `lane`: the lane that it drives, or
  // null. `next`: the lane that it is going to drive after that, or null.
  void renew(AgvId agv, std::uint32_t boot, StationId station, const Lane* lane, const Lane* next);
  // The same for a computer.
  void renew(EntityId computer, std::uint32_t boot) { briefings_[computer.index()].boot = boot; }

 private:
  void describe_scripts(const Scenario& scenario);
  void name_participants(const Scenario& scenario);
  fp_briefing common(const Scenario& scenario, const ToldPlant& plant, bool share_facts);

  std::vector<std::vector<fp_scripted_call>> scripts_;  // by AGV
  std::vector<const char*> agv_names_;
  std::vector<fp_computer> computers_;
  std::vector<std::unique_ptr<FactStore>> own_facts_;  // by participant, if they are not shared
  std::vector<fp_briefing> briefings_;                 // by participant
};

}  // namespace fleetproof
