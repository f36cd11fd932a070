#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// How large a plant is: what `import` prints, and what shows that a file was meant in another unit or place.
struct PlantSize {
  Vec2 extent_m = Vec2::Zero();                                           // of stations and control points
  double shortest_m = 0.0, median_m = 0.0, longest_m = 0.0, all_m = 0.0;  // of segments, each counted once
};

// Requires: problems_of(layout) is empty.
PlantSize size_of(const Layout& layout);

// "55.2 m x 36 m; segments of 0.5 m to 22.1 m, half of them up to 4.2 m, 310 m in all".
std::string size_text(const PlantSize& size);

// A question about the unit of a plant that is so large or so small that no AGV of a usual size is meant for it. Empty
// for others.
std::string size_question(const PlantSize& size);

// A question about the unit of the fastest speed limit, if no AGV is that fast; empty for others.
std::string speed_question(const Layout& layout);

// Moves a plant that lies beyond the range of coordinates, as plants in UTM coordinates do, near the origin, by whole
// hundreds of metres, so that all distances stay. `warnings` receives a sentence with the shift. Nothing happens to a
// plant that is within the range, or too large for it.
void shift_far_plant(Layout& layout, std::string_view source, std::vector<std::string>& warnings);

}  // namespace fleetproof
