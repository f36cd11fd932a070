#pragma once

#include <array>
#include <cstddef>

#include "core/clearance/phase_motion.hpp"

namespace fleetproof {

// The direction along which a gap is watched, from the first body towards the second. At every instant, any unit vector
// gives a lower bound of the clearance. The bound is good while the vector stays near the direction of the closest
// points. If a side is nearest and its body rotates, the axis is fixed to that body: else the far end of the side would
// swing into the gap. Between two corners, the axis is fixed to what turns most as the corners move.
class Axis {
 public:
  Axis() = default;
  Axis(const Separation& apart, const PhaseMotion& first, const PhaseMotion& second);

  enum class Tie { Floor, First, Second };
  Tie tie() const { return tie_; }
  Vec2 direction(const OrientedRectangle& first, const OrientedRectangle& second) const;

 private:
  static Tie tie_between_corners(const Separation& apart, const PhaseMotion& first, const PhaseMotion& second);

  Tie tie_ = Tie::Floor;
  Vec2 local_ = Vec2::UnitX();  // in the frame to which the axis is fixed
};

// A lower bound of the gap between two bodies along an axis, until one of the bodies changes its law of motion.
class GapBound {
 public:
  GapBound(const PhaseMotion& first, const PhaseMotion& second, const Axis& axis);

  // The gap itself, not a bound.
  bool exact() const { return exact_; }
  double now_m() const;
  // The gap between the corners that are nearest now, up to its second derivative. If the axis has just been measured,
  // value and rate are those of the clearance: it is the largest gap over all axes and thus stationary in the axis.
  struct Trend {
    double value_m, rate_mps, bend_mps2;
  };
  Trend trend() const;
  // The number of seconds for which the gap surely stays at or above the level; at most `horizon_s`. The number is
  // exact up to rounding.
  double safe_s(double level_m, double horizon_s) const;

 private:
  // One pair of corners, x seconds from now: no less than value + rate * x + bend_within(h) * x^2 / 2 for x <= h.
  struct Term {
    double value, rate, bend;
    double loss, loss_growth;    // of the bend: a third of the bound on the third derivative
    double least, least_growth;  // the second derivative's bound, negative

    double bend_within(double h_s) const {
      return std::max(bend - (loss + loss_growth * h_s) * h_s, least + least_growth * h_s);
    }
  };

  void add_corners_apart(const PhaseMotion& first, const PhaseMotion& second, const Vec2& direction);
  void add_corners_seen_from(const PhaseMotion& frame, const PhaseMotion& other, const Vec2& outward);
  void tighten_by_pivots(const PhaseMotion& frame, const PhaseMotion& other);
  double safe_within_s(double level_m, double horizon_s) const;

  std::array<Term, 16> terms_;  // only the first count_ are ever touched: most bounds have one
  std::size_t count_ = 0;
  bool exact_ = false;
};

}  // namespace fleetproof
