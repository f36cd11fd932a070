#pragma once

#include <cstdint>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/geometry/curve.hpp"
#include "core/geometry/rectangle.hpp"
#include "core/motion/motion_profile.hpp"

namespace fleetproof {

// How a body moves.
enum class Manner : std::uint8_t { Rest, Drive, Turn };

// One part of a body's timeline: the body rests, drives along a curve, or turns on the spot. The pieces of a body cover
// the whole run without a gap, so that a law misses nothing: the rest of a parked AGV is a piece like any other
// (Sect. 4.2 forgets it). The curve belongs to the layout of the scenario and outlives the run.
struct Piece {
  EntityId entity;
  std::uint64_t number = 0;  // unique in a run, ascending with begin
  Manner manner = Manner::Rest;
  SimTime begin = kStart;
  SimTime end = kForever;  // the planned end; earlier if the piece was cut short
  SegmentId segment;       // Drive only
  Footprint footprint;
  Pose start;                    // pose at begin
  const Curve* curve = nullptr;  // Drive only
  double way_begin_m = 0.0;      // Drive only: where on the curve the piece begins
  double turn_rad = 0.0;         // Turn only: signed, left positive
  MotionProfile profile;         // Drive: metres along the curve from way_begin_m; Turn: radians
  Box planned_box;               // swept_box(end) as planned; the world sets it before it announces the piece

  Pose pose_at(SimTime t) const;
  OrientedRectangle body_at(SimTime t) const;
  // Drive only: metres along the curve.
  double way_at(SimTime t) const;
  // Whether the body rests, or drives along one straight line.
  bool keeps_heading() const { return manner == Manner::Rest || (manner == Manner::Drive && curve->is_straight()); }
  // Whether it drives tail first, or turns right: then ways and speeds count against the heading, or against the left.
  bool moves_against_heading() const {
    return manner == Manner::Turn ? turn_rad < 0.0 : manner == Manner::Drive && curve->is_tail_first();
  }
  // Speed of the reference point.
  double speed_at(SimTime t) const;
  // The box of everything that the body covers from begin to `until`.
  Box swept_box(SimTime until) const;
};

Piece rest_piece(EntityId entity, const Footprint& footprint, const Pose& pose, SimTime begin);

}  // namespace fleetproof
