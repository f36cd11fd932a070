#include "core/motion/piece.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/tolerances.hpp"
#include "core/geometry/rotation.hpp"

namespace fleetproof {
namespace {

// A part of a curve between two arc lengths, swept by a footprint. The second derivative of a corner's path, times the
// squared length / 8, bounds its distance to a chord. The chords lie in the box of the bodies at their ends.
void add_swept(Box& box, const CurvePart& part, double from_m, double to_m, const Footprint& footprint,
               bool tail_first) {
  constexpr double kMostSteps = 1e4;
  const double length_m = to_m - from_m, turned_rad = part.most().per_m * length_m, arm_m = footprint.reach_m();
  const double sagitta_m =
      ((length_m + arm_m * turned_rad) * turned_rad + arm_m * part.most().per_m2 * length_m * length_m) / 8.0;
  const int steps = 1 + static_cast<int>(std::min(std::sqrt(sagitta_m / kBoxSlack_m), kMostSteps));
  Box bodies;
  for (int i = 0; i <= steps; ++i) {
    Pose pose = part.pose_at(from_m + length_m * i / steps);
    if (tail_first) pose.heading = -pose.heading;
    bodies.add(placed(footprint, pose));
  }
  const Box grown = bodies.grown(sagitta_m / steps / steps);
  box.add(grown.low_m);
  box.add(grown.high_m);
}

Box swept_drive(const Piece& piece, double until_m) {
  Box box;
  box.add(placed(piece.footprint, piece.curve->pose_at(piece.way_begin_m)));
  const auto parts = piece.curve->parts();
  const auto ends = piece.curve->ends_m();
  double begin_m = 0.0;
  for (std::size_t i = 0; i < parts.size() && begin_m < until_m; ++i) {
    const double skipped_m = std::max(0.0, piece.way_begin_m - begin_m);
    if (piece.way_begin_m < ends[i])
      add_swept(box, parts[i], skipped_m, std::min(until_m, ends[i]) - begin_m, piece.footprint,
                piece.curve->is_tail_first());
    begin_m = ends[i];
  }
  return box;
}

double elapsed_s(const Piece& piece, SimTime t) {
  return to_seconds(std::clamp(t, piece.begin, piece.end) - piece.begin);
}

}  // namespace

Pose Piece::pose_at(SimTime t) const {
  if (manner == Manner::Rest) return start;
  const double done = profile.position(elapsed_s(*this, t));
  if (manner == Manner::Drive) return curve->pose_at(way_begin_m + done);
  return {start.position_m, rotated(start.heading, unit_vector(turn_rad < 0.0 ? -done : done))};
}

double Piece::way_at(SimTime t) const { return way_begin_m + profile.position(elapsed_s(*this, t)); }

OrientedRectangle Piece::body_at(SimTime t) const { return placed(footprint, pose_at(t)); }

double Piece::speed_at(SimTime t) const { return manner == Manner::Drive ? profile.speed(elapsed_s(*this, t)) : 0.0; }

Box Piece::swept_box(SimTime until) const {
  if (manner == Manner::Drive) return swept_drive(*this, way_at(until));
  Box box;
  if (manner == Manner::Rest) {
    box.add(placed(footprint, start));
  } else {
    box.add(start.position_m);
    box = box.grown(footprint.reach_m());
  }
  return box;
}

Piece rest_piece(EntityId entity, const Footprint& footprint, const Pose& pose, SimTime begin) {
  Piece piece;
  piece.entity = entity;
  piece.begin = begin;
  piece.footprint = footprint;
  piece.start = pose;
  return piece;
}

}  // namespace fleetproof
