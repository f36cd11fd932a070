#pragma once

#include <algorithm>

#include "core/motion/piece.hpp"

namespace fleetproof {

// The direction of a walk through time.
enum class TimeSense : int { Forward = 1, Backward = -1 };

// A point of a body now, and bounds that hold until the phase of the body ends.
struct PointMotion {
  Vec2 position_m, velocity_mps, acceleration_mps2;
  double top_mps = 0.0, top_mps2 = 0.0, top_mps3 = 0.0;  // largest magnitudes of velocity, acceleration, jerk
};

// The motion of a body from an instant until its law of motion changes, at the next phase of its profile or the next
// part of its curve. Every point of the body has the velocity speed * lever. On a line or an arc, and in a turn, the
// lever is fixed to the body and turns by `curvature` times the distance driven. On a Bezier curve it also changes with
// the curvature, by the change times the arm of the point.
struct PhaseMotion {
  OrientedRectangle body;
  double centre_ahead_m = 0.0;  // of the reference point, whose speed this is
  double speed = 0.0;         // now, in the direction of the walk: m/s, ahead positive; in a turn rad/s, left positive
  double acceleration = 0.0;  // constant
  double top_speed = 0.0;     // largest magnitudes before the change, per length of the lever
  double top_acceleration = 0.0, top_jerk = 0.0;
  double curvature = 0.0;  // now, seen along the heading, 1/m; in a turn 1
  double bending = 0.0;    // now: the change of the curvature along the heading, 1/m2
  bool turns_on_spot = false;
  bool varies = false;  // the curvature changes
  // Largest magnitudes before the change: of the turning, and of what a point moves beyond the bounds of its lever as
  // the curvature changes, per length of its arm.
  struct Turning {
    double rad_s = 0.0, rad_s2 = 0.0, rad_s3 = 0.0;
  } top_turning;
  struct PerArm {
    double lever = 0.0, mps2 = 0.0, mps3 = 0.0;
  } per_arm;
  SimTime change = kForever;
  double lasts_s = 0.0;  // until the change

  bool rotates() const { return curvature != 0.0 || varies; }
  double turning_rad_s() const { return curvature * speed; }
  double turning_rad_s2() const { return curvature * acceleration + bending * speed * speed; }
  // The centre of the rotation, from the body's centre: the point of the body that stands still now.
  Vec2 pivot_arm() const {
    const Vec2 reference = -centre_ahead_m * body.heading;
    return turns_on_spot ? reference : Vec2(reference + left_of(body.heading) / curvature);
  }
  // `arm` leads from the body's centre to the point.
  PointMotion point(const Vec2& arm) const;
  // Half of the body's width as seen along a direction.
  double half_extent_m(const Vec2& direction) const;
};

// The motion of `piece` from `t` on, when its body is `body`; `limit` bounds the change.
PhaseMotion motion_from(const Piece& piece, const OrientedRectangle& body, SimTime t, SimTime limit, TimeSense sense);

}  // namespace fleetproof
