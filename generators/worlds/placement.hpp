#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "generators/map/reachability.hpp"
#include "generators/map/rejection_counts.hpp"

namespace fleetproof {

// How a fleet stands at the start.
enum class Placement : std::uint8_t {
  Random,       // on places to wait, drawn
  ChargerBank,  // on the stations nearest to one charger
  Adversarial,  // in pairs whose first drives meet: encounter_pairs.hpp
  Symmetric,    // in pairs that reach one station at the same instant
  Mixed,        // each world one of the above: 40 % adversarial, 30 % random, 20 % charger bank, 10 % symmetric
};
constexpr const char* name_of(Placement placement) {
  switch (placement) {
    case Placement::Random:
      return "random";
    case Placement::ChargerBank:
      return "charger-bank";
    case Placement::Adversarial:
      return "adversarial";
    case Placement::Symmetric:
      return "symmetric";
    case Placement::Mixed:
      return "mixed";
  }
  return kNoWord;
}
inline constexpr auto kPlacements = kValuesOf<Placement>;

// The placement of a world: `placement` itself or, if that is mixed, one of the others, drawn from the placement stream
// `key`.
Placement placement_of_world(Placement placement, std::uint64_t key);

// Puts AGVs of the scenario's first vehicle type beside those already there until there are `fleet_size`, on different
// stations from which all others can be reached, places to park, charge or store first, each heading along a lane that
// leaves its station. `key` is that of the placement stream, `attempt` its topic; an AGV's draws do not depend on the
// AGVs after it. False if there is no room; then `scenario.agvs` is as far as it got.
bool place_fleet(Scenario& scenario, std::uint32_t fleet_size, const Reachability& reachability, std::uint64_t key,
                 std::uint32_t attempt, RejectionCounts& counts);

// The same, on the stations nearest to a drawn charger, it included; without a charger, to a drawn place to wait.
bool place_at_charger_bank(Scenario& scenario, std::uint32_t fleet_size, const Reachability& reachability,
                           std::uint64_t key, std::uint32_t attempt, RejectionCounts& counts);

// Places to park, charge or store in the core; if there are none, all of it.
std::vector<StationId> places_to_start(const LogicalMap& map, const Reachability& reachability);

// Adds an AGV to the fleet unless it would stand too close to another one or to an obstacle; then that is counted.
bool add_agv(Scenario& scenario, StationId start, const Vec2& heading, RejectionCounts& counts);

}  // namespace fleetproof
