#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "generators/map/reachability.hpp"
#include "generators/map/rejection_counts.hpp"
#include "generators/worlds/placement.hpp"

namespace fleetproof {

// Two AGVs that will meet on their first drives, between their starts and the beginnings of their first transports.
struct EncounterPair {
  std::uint32_t first = 0, second = 0;  // indices of AGVs
  StationId first_goal, second_goal;
  Duration second_after{};  // how much later the second AGV must leave, so that they meet; negative: earlier
};

// Puts pairs of AGVs, AGV 2k and 2k+1, on their starts until the fleet has fewer than two places left or no pair is
// found; the rest is for place_fleet. If both AGVs of a pair drive the quickest way (timetable.hpp), no other being as
// quick,
// * Adversarial: and leave at the same instant, they begin to drive one two-way segment from its two ends, or failing
// that reach a station by
//   different segments, less than 1 s apart;
// * Symmetric: they reach a station by different segments, at the same instant if the second leaves `second_after` the
// first. That is less than 1 s
//   and as little as a few draws bring it: none at all where the layout is as symmetric.
// Goals are stations where transports begin (order_ends()). The scenario needs map, vehicle type and law; obstacles are
// regarded.
std::vector<EncounterPair> place_pairs(Scenario& scenario, std::uint32_t fleet_size, Placement placement,
                                       const Reachability& reachability, std::uint64_t key, std::uint32_t attempt,
                                       RejectionCounts& counts);

// Lets the first transports of every pair begin at its goals and be released at the earlier of the two instants drawn,
// one of them later if the pair is to meet so. What is released after them waits for that.
void send_to_meet(Scenario& scenario, const std::vector<EncounterPair>& pairs);

}  // namespace fleetproof
