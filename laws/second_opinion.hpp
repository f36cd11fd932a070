#pragma once

#include "core/geometry/rectangle.hpp"

// What FCL says about two rectangles: the answer to overlap in the published laws, a second opinion on what the exact
// law files.
namespace fleetproof {

// Whether the rectangles share a point. Reliable to rounding: no false or missed overlap is known of FCL's test of two
// boxes.
bool overlap_by_fcl(const OrientedRectangle& first, const OrientedRectangle& second);

// Euclidean distance; zero in an overlap.
double clearance_by_fcl(const OrientedRectangle& first, const OrientedRectangle& second);

// Throws InvariantViolation if FCL denies `clearance_m` between the two: by more than 0.1 mm (an overlap counts as
// zero), or about whether they overlap where that is deeper, or the gap wider, than a micrometre.
void confirm_clearance(const OrientedRectangle& first, const OrientedRectangle& second, double clearance_m);

}  // namespace fleetproof
