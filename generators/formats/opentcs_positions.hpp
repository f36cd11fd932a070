#pragma once

#include <map>
#include <string>

#include "core/scenario/layout.hpp"
#include "generators/formats/read_choice.hpp"

namespace fleetproof {

// A plant model can give each point two positions: one in the plant, one in the drawing. Control points belong to the
// drawing. Curves that mix the two are nonsense.
//
// Requires: the stations have the positions of the plant. If the drawing has the same positions (to 1 mm), nothing
// happens. If it has others, one set is taken for all stations, by what the file shows:
// * A model with curves takes the drawing. It keeps the plant if the curves become much shorter that way.
// * A model without curves keeps the plant. It takes the drawing if two stations of a segment are on one spot in the
//   plant and apart in the drawing.
// * If a station on a segment has no position in the drawing, all keep the plant. Other stations keep theirs.
// A wish of the user comes before what the file shows; then stations without a position in the drawing keep theirs.
//
// Returns a sentence that says which positions were taken, and why; empty if there was no choice.
std::string settle_positions(Layout& layout, const std::map<std::string, Vec2>& drawn_m,
                             Positions wish = Positions::ByFile);

// A sentence on the curves that lead far away from their stations, which suggests that their control points belong to
// other coordinates; empty if there are none.
std::string detours_of(const Layout& layout);

}  // namespace fleetproof
