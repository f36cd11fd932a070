// How fast two bodies approach each other.
#pragma once

#include "core/clearance/clearance_over_time.hpp"
#include "core/clearance/phase_motion.hpp"

namespace fleetproof {

// How fast two bodies move against each other where they are nearest.
struct RelativeSpeed {
  double speed_mps = 0.0;   // of the two nearest points, each as it moves with its body, also by rotation
  double normal_mps = 0.0;  // the part of it along the line between them; above zero if they come nearer
};

// At an instant. If several pairs of points are nearest (an edge along an edge, an overlap), those that move fastest
// against each other count. A piece moves up to its end: at an end by contact, this is the speed just before the stop.
RelativeSpeed relative_speed(const Piece& a, const Piece& b, SimTime t);

// How fast the clearance changes from an instant on, in the direction of a walk through time: below zero if the walk
// finds the bodies nearer. If several pairs of points are nearest, the pair that comes nearer fastest decides.
// Requires: the bodies do not overlap.
double clearance_rate_mps(const Piece& a, const Piece& b, SimTime t, TimeSense sense);

// The fastest instant of an interval, among those with a clearance below `below_m`. Zero if there is none. A result
// below `matters_from_mps` may be any speed below it, which costs less.
RelativeSpeed fastest_below(const Piece& a, const Piece& b, Interval within, double below_m, EvaluationCount& count,
                            double matters_from_mps = 0.0);

}  // namespace fleetproof
