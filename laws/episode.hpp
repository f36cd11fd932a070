#pragma once

#include <vector>

#include "core/base/tolerances.hpp"
#include "core/clearance/relative_speed.hpp"
#include "core/outcome/outcome.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The threshold of all laws: a smaller clearance is a violation.
inline double violation_threshold_m(const LawSetup& law) { return law.safety_distance_m - kBuiltToTheLimit_m; }

// What is taken off the threshold for two pieces: kBuiltOnCurves_m for each that drives a curve.
inline double allowance_on_curves_m(const Piece& a, const Piece& b) {
  const auto on_curve = [](const Piece& piece) {
    return piece.manner == Manner::Drive && !piece.curve->is_straight() ? kBuiltOnCurves_m : 0.0;
  };
  return on_curve(a) + on_curve(b);
}

// A time in which two bodies are too close, and how they stand at the closest instant. `a` < `b`.
struct Episode {
  EntityId a, b;
  SimTime first = kStart, last = kStart;
  ClosestApproach closest;
  OrientedRectangle body_a, body_b;  // at closest.at
  bool contact = false;              // the bodies touch, first at closest.at
  RelativeSpeed speed;               // the highest during the contact, or while the clearance is the least

  // Adds an episode of the same pair. A contact, or else the smaller clearance, is kept. Of two contacts, or of two
  // equal clearances, the earlier one is kept with the higher speed.
  void absorb(const Episode& other);
};

// Makes an episode from two pieces, in either order, with the speed at closest.at. Requires: both pieces cover
// closest.at.
Episode episode_of(const Piece& one, const Piece& other, SimTime first, SimTime last, const ClosestApproach& closest);

// Joins the episodes of a pair that overlap or follow each other within `seam`. Ordered by (a, b, first).
std::vector<Episode> joined(std::vector<Episode> episodes, Duration seam);

// The violations to file, ordered by (first, a, b). Lengths and speeds are whole micrometres: the clearance is rounded
// down, the others to nearest.
std::vector<Violation> filed(const std::vector<Episode>& episodes);

}  // namespace fleetproof
