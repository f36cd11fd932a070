#pragma once

#include "core/geometry/rectangle.hpp"

// What FCL says about two rectangles. The published laws use it to test for overlap. The exact law uses it as a second
// opinion on what it files.
namespace fleetproof {

// Whether the rectangles share a point, exact up to rounding. No false and no missed overlap of FCL's box test is
// known.
bool overlap_by_fcl(const OrientedRectangle& first, const OrientedRectangle& second);

// Throws InvariantViolation if FCL contradicts `clearance_m`. The distances may differ by 0.1 mm; an overlap counts as
// distance zero. Only one of the two may find an overlap if the overlap or the gap is less than a micrometre.
void confirm_clearance(const OrientedRectangle& first, const OrientedRectangle& second, double clearance_m);

}  // namespace fleetproof
