#pragma once

#include <array>
#include <cstddef>

#include "core/phase_motion.hpp"

namespace fleetproof {

// The direction along which a gap is watched, from the first body towards the second. Any unit vector at any instant bounds the clearance from
// below. Where the nearest feature of a rotating body is its side, the direction turns with it; a direction at rest would let the far end of that
// side swing into the gap. Else it is fixed.
class Axis {
 public:
  Axis() = default;
  Axis(const Vec2& direction, const PhaseMotion& first, const PhaseMotion& second);

  enum class Tie { Floor, First, Second };
  Tie tie() const { return tie_; }
  Vec2 direction(const OrientedRectangle& first, const OrientedRectangle& second) const;

 private:
  Tie tie_ = Tie::Floor;
  Vec2 local_ = Vec2::UnitX();  // in the frame it is tied to
};

// The gap between two bodies along an axis, from below, until one of them changes its law of motion.
class GapBound {
 public:
  GapBound(const PhaseMotion& first, const PhaseMotion& second, const Axis& axis);

  // The gap, not a bound of it.
  bool exact() const { return exact_; }
  double now_m() const;
  // The gap stays at or above the level for at least this many seconds, or up to `horizon_s`. A time within rounding of the true one.
  double safe_s(double level_m, double horizon_s) const;

 private:
  // One pair of corners, x seconds from now: no less than value + rate * x + bend_within(h) * x^2 / 2 for x <= h.
  struct Term {
    double value = 0.0, rate = 0.0, bend = 0.0;
    double loss = 0.0, loss_growth = 0.0;    // of the bend: a third of the bound on the third derivative
    double least = 0.0, least_growth = 0.0;  // the second derivative's bound, negative

    double bend_within(double h_s) const { return std::max(bend - (loss + loss_growth * h_s) * h_s, least + least_growth * h_s); }
  };

  void add_corners_apart(const PhaseMotion& first, const PhaseMotion& second, const Vec2& direction);
  void add_corners_from_side(const PhaseMotion& sided, const PhaseMotion& other, const Vec2& outward);
  double safe_within_s(double level_m, double horizon_s) const;

  std::array<Term, 16> terms_;
  std::size_t count_ = 0;
  bool exact_ = false;
};

}  // namespace fleetproof
