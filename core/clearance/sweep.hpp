#pragma once

#include <vector>

#include "core/geometry/curve.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof {

// What a body covers as it moves, whenever that is: the places that it takes one after the other.
class Sweep {
 public:
  // A body of this size that is nowhere yet.
  explicit Sweep(const Footprint& footprint) : footprint_(footprint) {}

  // About the reference point, from the heading of `pose` on. Signed, left positive; 0: it rests.
  void add_turn(const Pose& pose, double turn_rad);
  // Requires: the curve outlives the sweep.
  void add_drive(const Curve& curve);

 private:
  friend bool may_come_closer(const Sweep& a, const Sweep& b, double distance_m);

  // A part of it between two values of `at`: radians of a turn, or metres along a curve.
  struct Stretch {
    enum class Kind : unsigned char { Straight, Turn, Bend } kind = Kind::Straight;
    Pose start;                       // Straight, Turn
    const CurvePart* part = nullptr;  // Bend
    bool tail_first = false;          // Bend
    double from = 0.0, to = 0.0;
  };
  // A rectangle, and how far the body may reach beyond it.
  struct Cover {
    OrientedRectangle rectangle;
    double slack_m = 0.0;
  };
  Cover cover(const Stretch& stretch) const;

  Footprint footprint_;
  std::vector<Stretch> stretches_;
};

// How far apart two sweeps may be that are told to come closer than a distance, beyond it: where a body turns or drives
// a bend, it is covered by rectangles. Bodies that rest or drive straight on are covered exactly.
inline constexpr double kSweepSlack_m = 0.002;

// Whether the bodies may come closer to each other than this, wherever each of them is. False is certain, to
// kBuiltToTheLimit_m. True is right but for kSweepSlack_m.
bool may_come_closer(const Sweep& a, const Sweep& b, double distance_m);

}  // namespace fleetproof
