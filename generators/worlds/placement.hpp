#pragma once

#include <cstdint>
#include <span>
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

// The placement of a world: `placement` itself. If that is Mixed: another one, drawn from the placement stream `key`.
Placement placement_of_world(Placement placement, std::uint64_t key);

// The types of a fleet, by AGV, as in Reachability.
using FleetTypes = std::span<const std::uint32_t>;

// Adds AGVs of the first vehicle type of the scenario until the fleet has as many AGVs as `types`. Each AGV stands on a
// station of its own where its type can start, heading along a lane that leaves it. Places to park,
// charge or store come first. `key` is the key of the placement stream, `attempt` its topic. The draws of an AGV do not
// depend on the AGVs after it. Returns false if there is no room; the scenario then contains the AGVs that found a
// place.
bool place_fleet(Scenario& scenario, FleetTypes types, const Reachability& reachability, std::uint64_t key,
                 std::uint32_t attempt, RejectionCounts& counts);

// The same, on a drawn charger and the stations nearest to it. Without a charger: a drawn place to wait.
bool place_at_charger_bank(Scenario& scenario, FleetTypes types, const Reachability& reachability, std::uint64_t key,
                           std::uint32_t attempt, RejectionCounts& counts);

// The places to park, charge or store where an AGV of some type can start. If there are none: all stations where one
// can start.
std::vector<StationId> places_to_start(const LogicalMap& map, const Reachability& reachability);

// Adds an AGV to the fleet. If it would stand too close to another AGV or to an obstacle, loaded bodies counting, it
// is not added; `counts` counts the reason, and the function returns false.
bool add_agv(Scenario& scenario, StationId start, const Vec2& heading, RejectionCounts& counts);

}  // namespace fleetproof
