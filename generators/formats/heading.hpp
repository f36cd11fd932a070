#pragma once

#include <string>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

inline constexpr double kLargestHeading_rad = 1e4;  // of an angle in a file

// The heading of an angle in a file. An angle within 0.002 rad of a quarter turn is that quarter turn: files round
// 1.5707963 to 1.57. Requires: |angle_rad| <= kLargestHeading_rad.
Vec2 heading_at(double angle_rad);

// An AGV stands at a station as it arrives. If a lane arrives there within 1 degree of the heading that the station
// asks for, the station asks for the heading of that lane from then on. Otherwise it asks for none: its name is
// returned. Requires: problems_of(layout) is empty.
std::vector<std::string> settle_headings(Layout& layout);

}  // namespace fleetproof
