#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// `safety-distance`: the exact law, less what the scenario exempts.
//
// Exempt is a violation of two bodies that a pair of scenario.law.exempt_pairs names, in either order: kinds of
// vehicles, or one of these and every obstacle and fallen load. Exempt is, too, a violation during all of which the
// reference points of both bodies are within scenario.law.exempt_radius_m of one station that serves one of
// scenario.law.exempt_purposes, such as AGVs side by side in a charger bank. A violation that begins or goes on outside
// is filed as a whole. Contact is never exempt. The smallest clearance of the run still counts everything.
std::unique_ptr<Law> make_safety_distance_law(const Scenario& scenario);

}  // namespace fleetproof
