#pragma once

#include <string>
#include <string_view>

#include "core/scenario/layout.hpp"
#include "generators/map/problem.hpp"

namespace fleetproof {

inline constexpr double kLargestCoordinate_m = 100'000.0;  // from the origin
inline constexpr double kShortestSegment_m = 0.01;
inline constexpr double kSharpestBend_m = 0.05;  // radius
inline constexpr double kWidestFloor_m = 100.0;  // of a lane
// Sharper bends are none if they turn by less: the curvature of a Bezier curve whose control point lies on its end has
// no limit there, and the heading hardly changes.
inline constexpr double kSharpBendTurns_rad = 0.1;

// The problems that make a layout unusable as a LogicalMap; empty if there are none. Pointers are relative to the
// layout.
Problems problems_of(const Layout& layout);

// Whether a point is within the range of coordinates.
bool on_the_floor(const Vec2& point_m);

// Why an AGV cannot drive a segment with this curve; empty if it can.
std::string fault_of_curve(const Curve& curve);

// Why this is not a valid name (1 to 200 bytes of UTF-8 without control characters); null if it is valid.
const char* fault_of_name(std::string_view name);

// The largest angle, in radians, between the control points on the two sides of a joint of Bezier pieces.
double largest_kink_rad(const Segment& segment);

// Moves the control points beside every such joint onto one common tangent. Their distances from the joint stay.
void smooth_joints(Segment& segment);

// Sets the floor of the layout: the smallest rectangle with all stations and control points, grown by `margin_m`.
void fit_floor(Layout& layout, double margin_m);

// The margin of a floor that a file does not give; and whether a layout has that floor.
inline constexpr double kFloorMargin_m = 3.0;
bool has_fitted_floor(const Layout& layout);

}  // namespace fleetproof
