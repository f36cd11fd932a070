#pragma once

#include <cstdint>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/geometry/curve.hpp"
#include "core/geometry/rectangle.hpp"
#include "core/motion/motion_profile.hpp"

namespace fleetproof {

// What a body is doing about its position.
enum class Manner : std::uint8_t { Rest, Drive, Turn };

// One stretch of a body's timeline: it rests, drives along a curve, or turns on the spot. Together the pieces of a body
// cover the whole run without gap, which is what lets a law miss nothing: the rest of a parked AGV is a piece like any
// other (Sect. 4.2 forgets it). The curve is not owned; it belongs to the scenario's layout and outlives the run.
struct Piece {
  EntityId entity;
  std::uint64_t number = 0;  // unique in a run, ascending with begin
  Manner manner = Manner::Rest;
  SimTime begin = kStart;
  SimTime end = kForever;  // planned; earlier if the piece was cut short
  SegmentId segment;       // Drive only
  Footprint footprint;
  Pose start;                    // pose at begin
  const Curve* curve = nullptr;  // Drive only
  double way_begin_m = 0.0;      // Drive only: where on the curve the piece begins
  double turn_rad = 0.0;         // Turn only: signed, left positive
  MotionProfile profile;         // Drive: metres along the curve from way_begin_m; Turn: radians
  Box planned_box;  // swept_box(end) as planned; the world fills it in when the piece begins, before it announces it

  Pose pose_at(SimTime t) const;
  OrientedRectangle body_at(SimTime t) const;
  // Drive only: metres along the curve.
  double way_at(SimTime t) const;
  // It rests, or drives along one straight line.
  bool keeps_heading() const { return manner == Manner::Rest || (manner == Manner::Drive && curve->is_straight()); }
  // Speed of the reference point.
  double speed_at(SimTime t) const;
  // Everything the body covers from begin to `until`, boxed.
  Box swept_box(SimTime until) const;
};

Piece rest_piece(EntityId entity, const Footprint& footprint, const Pose& pose, SimTime begin);

}  // namespace fleetproof
