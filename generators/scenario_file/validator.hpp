// What makes a scenario invalid: its layout, its AGVs and their scripts.
#pragma once

#include "core/scenario/scenario.hpp"
#include "generators/map/problem.hpp"
#include "generators/map/reachability.hpp"

namespace fleetproof {

inline constexpr double kSmallestCoreShare = 0.9;

// Checks generated and hand-written scenarios alike. A problem has the JSON pointer of its field in the scenario file.

// The problems that make a scenario impossible to run: numbers out of range, names, references, an empty fleet. The map
// is not checked again.
Problems unusable_problems(const Scenario& scenario);

// The problems that make a scenario a poor test: stations that cannot reach each other, starts closer than the safety
// distance, starts from which no lane leads on, transports that cannot be driven. Requires: the scenario has no
// unusable problems; `reachability` belongs to its map.
Problems world_problems(const Scenario& scenario, const Reachability& reachability);

// The unusable problems. If there are none: the problems that make the scenario a poor test.
Problems problems_of(const Scenario& scenario);

// Whether two bodies at rest are closer than `distance_m`. A micrometre less is allowed, because lanes may be built to
// measure.
bool closer_than(const OrientedRectangle& a, const OrientedRectangle& b, double distance_m);

// The place that an AGV needs at its start: its largest body, because the AGV may pick a load there.
OrientedRectangle start_body(const Scenario& scenario, const AgvSetup& agv);

}  // namespace fleetproof
