#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "generators/map/reachability.hpp"
#include "generators/map/rejection_counts.hpp"
#include "generators/worlds/placement.hpp"
#include "generators/worlds/transports.hpp"

namespace fleetproof {

// Two AGVs that will meet on their first drives, between their starts and the beginnings of their first transports.
struct EncounterPair {
  std::uint32_t first = 0, second = 0;  // indices of AGVs
  StationId first_goal, second_goal;
  Duration second_after{};  // how much later the second AGV must leave, so that they meet; negative: earlier
};

// Places pairs of AGVs, AGV 2k and 2k+1, until fewer than two AGVs are missing or no pair is found. place_fleet places
// the other AGVs. Both AGVs of a pair have one quickest way (timetable.hpp); no other way is as quick. If both drive
// it, then
// * Adversarial: if they leave at the same instant, they start to drive one two-way segment from its two ends within
//   1 s. If no such pair is found, they reach a station by different segments, less than 1 s apart.
// * Symmetric: they reach a station by different segments at the same instant, if the second AGV leaves `second_after`
//   the first. This time is less than 1 s, and zero if the layout is symmetric enough.
// Each goal is a station where transports of the AGV's type begin (OrderEnds). No AGV starts near an obstacle.
// Requires: the scenario has map, vehicle type and law.
std::vector<EncounterPair> place_pairs(Scenario& scenario, FleetTypes types, Placement placement,
                                       const Reachability& reachability, std::uint64_t key, std::uint32_t attempt,
                                       RejectionCounts& counts);

// Changes the first transports of every pair: they begin at the goals of the pair. Both are released at the earlier of
// their two instants, or one of them by `second_after` later. Later transports are not released before the first.
// `ends`: by type; the goals of a pair are among the picks of its types.
void send_to_meet(Scenario& scenario, const std::vector<EncounterPair>& pairs, const std::vector<OrderEnds>& ends);

}  // namespace fleetproof
