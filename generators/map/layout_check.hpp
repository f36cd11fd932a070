#pragma once

#include <string>
#include <string_view>

#include "core/scenario/layout.hpp"
#include "generators/map/problem.hpp"

namespace fleetproof {

inline constexpr double kLargestCoordinate_m = 100'000.0;  // from the origin
inline constexpr double kShortestSegment_m = 0.01;
inline constexpr double kSharpestBend_m = 0.05;  // radius

// What keeps a layout from becoming a LogicalMap; empty if nothing does. Pointers are relative to the layout.
Problems problems_of(const Layout& layout);

// Whether a point is within the range of coordinates.
bool on_the_floor(const Vec2& point_m);

// What keeps an AGV from driving a segment with this curve; empty if nothing does.
std::string fault_of_curve(const Curve& curve);

// How a name breaks the rules for names (1 to 200 bytes of UTF-8 without control characters); null if it does not.
const char* fault_of_name(std::string_view name);

// The largest angle, in radians, between the control points on the two sides of a joint of Bezier pieces.
double largest_kink_rad(const Segment& segment);

// Turns the control points beside every such joint onto one common tangent, their distances from it unchanged.
void smooth_joints(Segment& segment);

// The smallest rectangle that holds stations and control points, grown by `margin_m`, as the layout's floor.
void fit_floor(Layout& layout, double margin_m);

}  // namespace fleetproof
