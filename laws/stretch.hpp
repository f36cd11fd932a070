#pragma once

#include <vector>

#include "core/clearance/clearance_over_time.hpp"
#include "core/outcome/outcome.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The one threshold of every law: closer than this is a violation. It lies a micrometre below the minimal safety
// distance, so that lanes built at exactly that distance are not accused by a rounding error.
inline constexpr double kBuiltToTheLimit_m = 1e-6;
inline double violation_threshold_m(const LawSetup& law) { return law.safety_distance_m - kBuiltToTheLimit_m; }

// Closer than this is contact: the world stops bodies at their touch when about a micrometre is between them, and that
// reads 1 or 0 as filed.
inline constexpr double kContact_m = 2e-6;

// A violation in the making: a stretch of time in which two bodies are too close, and how they stand at their closest.
// `a` < `b`.
struct Stretch {
  EntityId a, b;
  SimTime first = kStart, last = kStart;
  ClosestApproach closest;
  OrientedRectangle body_a, body_b;           // at closest.at
  Vec2 relative_velocity_mps = Vec2::Zero();  // of the reference points, at closest.at

  bool contact() const { return closest.clearance_m < kContact_m; }
  // Takes in a stretch of the same pair. The smaller clearance stays; of two contacts, or two equal clearances, the
  // earlier one.
  void absorb(const Stretch& other);
};

// The two pieces, in either order; both cover closest.at.
Stretch stretch_of(const Piece& one, const Piece& other, SimTime first, SimTime last, const ClosestApproach& closest);

// One stretch for all of a pair that overlap or follow each other within `seam`. Ordered by (a, b, first).
std::vector<Stretch> joined(std::vector<Stretch> stretches, Duration seam);

// As filed, ordered by (first, a, b). Lengths and speeds are whole micrometres: the clearance rounded down, the others
// to nearest.
std::vector<Violation> filed(const std::vector<Stretch>& stretches);

}  // namespace fleetproof
