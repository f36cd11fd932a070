#pragma once

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// Two diagonal cross aisles that rise from the middle of the front. Picking aisles above them are vertical, picking
// aisles below them are horizontal (Gue and Meller). An AGV that picks blocks its aisle. Stress: diagonals of 20-30 or
// 60-70 degrees, stations at least 2.1 m apart, every aisle two-way.
Layout make_fishbone(Draws& draws, Range range);

}  // namespace fleetproof
