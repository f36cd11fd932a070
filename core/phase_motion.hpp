#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/piece.hpp"

namespace fleetproof {

// Which way time is walked.
enum class TimeSense : int { Forward = 1, Backward = -1 };

// How a body moves from an instant on, until its law of motion next changes: where its profile begins another phase or its curve another arc.
// Every corner has the velocity speed * u, where u is fixed to the body (see `lever`) and turns by `curvature` times the way made.
struct PhaseMotion {
  OrientedRectangle body;
  double speed = 0.0;         // now, in the sense walked: m/s; in a turn rad/s, left positive
  double acceleration = 0.0;  // constant
  double top_speed = 0.0;     // largest magnitude before the change
  double curvature = 0.0;     // 1/m; in a turn 1
  bool turns_on_spot = false;
  SimTime change = kForever;

  bool rotates() const { return curvature != 0.0; }
  // Way of a point of the body per unit of `speed`; `arm` leads from the reference point to it.
  Vec2 lever(const Vec2& arm) const { return turns_on_spot ? left_of(arm) : Vec2(body.heading + curvature * left_of(arm)); }
};

// The motion of `piece` from `t` on; `limit` bounds the change.
PhaseMotion motion_from(const Piece& piece, SimTime t, SimTime limit, TimeSense sense);

// One corner's extent along a direction, x seconds from now, within the phase: at most value + rate * x + bend_within(h) * x^2 / 2 for x <= h.
struct Extent {
  double value = 0.0, rate = 0.0;
  double bend = 0.0, bend_growth_per_s = 0.0, most_bend = 0.0;

  double bend_within(double horizon_s) const { return std::min(bend + bend_growth_per_s * horizon_s, most_bend); }
};

// How far a body extends along a direction: the largest of these. A single, exact one unless the body rotates.
struct Reach {
  std::array<Extent, 4> of;
  std::size_t count = 0;
};
Reach reach(const PhaseMotion& motion, const Vec2& direction);

}  // namespace fleetproof
