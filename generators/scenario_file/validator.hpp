#pragma once

#include "core/scenario/scenario.hpp"
#include "generators/map/problem.hpp"
#include "generators/map/reachability.hpp"

namespace fleetproof {

inline constexpr double kSmallestCoreShare = 0.9;

// One judge for generated and for hand-written scenarios. Pointers are those of the scenario file.

// What keeps a scenario from being run at all: numbers out of range, names, references, an empty fleet. The map is
// taken as sound.
Problems unusable_problems(const Scenario& scenario);

// What makes it a poor test: stations that cannot reach each other, starts closer than the safety distance, transports
// that cannot be driven. Only for a scenario without unusable problems; `reachability` is that of its map.
Problems world_problems(const Scenario& scenario, const Reachability& reachability);

// The former or, if there are none, the latter.
Problems problems_of(const Scenario& scenario);

// Whether two bodies at rest are closer than `distance_m`, by more than the micrometre that lanes built to measure are
// allowed.
bool closer_than(const OrientedRectangle& a, const OrientedRectangle& b, double distance_m);

// The place that an AGV needs at its start: its largest body, which is the loaded one, since it may pick a load there.
OrientedRectangle start_body(const Scenario& scenario, const AgvSetup& agv);

}  // namespace fleetproof
