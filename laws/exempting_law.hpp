#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// `safety-distance`: the exact law without the violations that the scenario exempts. Two kinds of violations are
// exempt:
// - violations of two bodies that a pair of scenario.law.exempt_pairs names, in either order. A pair consists of two
//   vehicle types, or of a vehicle type and "obstacle" (every obstacle and fallen load);
// - violations during which the reference points of both bodies stay within scenario.law.exempt_radius_m of one station
//   with a purpose of scenario.law.exempt_purposes, for example AGVs side by side in a charger bank. A violation that
//   begins or continues outside is filed as a whole.
// Contact is never exempt. The smallest clearance of the run includes exempt violations.
std::unique_ptr<Law> make_safety_distance_law(const Scenario& scenario);

}  // namespace fleetproof
