#pragma once

#include <optional>

#include "tests/oracle/trajectory.hpp"

// What a clock of 10 microseconds sees of two trajectories.
//
// Looking at each of 300 000 instants of each of 100 000 pairs would take days. The clock leaves out ticks at which
// provably nothing can be seen: an interval between two looked-at ticks is halved unless the clearance cannot fall
// below the level within it. Two bounds prove that, both written from scratch and both rigorous: no point is faster
// than its trajectory's fastest (first order), and the gap between the bodies along one fixed direction bounds the
// clearance from below and is bent by no more than the strongest accelerations (second order; not over a joint of two
// strokes). What is left is looked at tick by tick.
namespace fleetproof::oracle {

struct TrajectoryPair {
  Trajectory a, b;
  Nanoseconds begin = 0, end = 0;  // common interval
};

// Euclidean distance of two rectangles given by their corners; 0 if they share a point.
double distance_m(const Corners& a, const Corners& b);
double clearance_m(const TrajectoryPair& pair, Nanoseconds t);

// First tick at which the clearance is below the level, moved back to the nanosecond at which it fell below it. The
// last instant is a tick too.
std::optional<Nanoseconds> first_below(const TrajectoryPair& pair, double level_m);

struct Lowest {
  double clearance_m = 0.0;
  Nanoseconds at = 0;
};
// Smallest clearance to a nanometre: over the ticks, and between the neighbours of the lowest one.
Lowest lowest(const TrajectoryPair& pair);

// How fast the nearest points move against each other at an instant: material points of the bodies, looked at shortly
// before and after. The fastest, where several pairs are nearest. Requires: the bodies are apart, no joint is near.
struct Speed {
  double speed_mps = 0.0, closing_mps = 0.0;
};
Speed relative_speed(const TrajectoryPair& pair, Nanoseconds t);

// The smallest clearance without proof, by samples and thirds: for tuning a pair.
double roughly_lowest_m(const TrajectoryPair& pair);

}  // namespace fleetproof::oracle
