#pragma once

#include "laws/stretch.hpp"

namespace fleetproof {

// A stretch of two pieces as the exact law files it. `closest` is the closest approach that the search has found.
//
// If the bodies touch, the closest instant is the first touch, as the world dates it; the speed is the highest during
// the contact. Else the closest instant is the bottom of the first minimum of the least clearance, and the speed is the
// highest while the clearance stays the same.
// Requires: both pieces cover [first, last]; the clearance is below the threshold at both ends.
Stretch judged_stretch(const Piece& one, const Piece& other, SimTime first, SimTime last,
                       const ClosestApproach& closest, EvaluationCount& count);

}  // namespace fleetproof
