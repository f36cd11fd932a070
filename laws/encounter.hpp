// How close two lanes of a map come to each other when both are driven.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/curve.hpp"
#include "core/geometry/rectangle.hpp"
#include "core/outcome/probe_names.hpp"

namespace fleetproof {

// The middle of the track of a straight drive, from the tail of the body at the start to its nose at the end. What two
// straight tracks are to each other is often plain from it, without the points of the tracks.
struct MiddleLine {
  Vec2 begin_m = Vec2::Zero(), travel = Vec2::UnitX();
  double length_m = 0.0;

  // Requires: the curve is straight.
  static MiddleLine of(const Curve& curve, const Footprint& footprint);
  Vec2 end_m() const { return begin_m + length_m * travel; }
  // From a point to the nearest one of the line.
  double square_distance_m2(const Vec2& point_m) const;
  // True only if the lines are farther apart than this: most lines that are so are found.
  static bool are_apart(const MiddleLine& a, const MiddleLine& b, double distance_m) {
    return a.has_aside(b, distance_m) || b.has_aside(a, distance_m);
  }

 private:
  bool has_aside(const MiddleLine& other, double distance_m) const;
};

// The track of a drive with its width: what is needed to judge encounters. It does not refer to the curve from which it
// was made.
struct Track {
  struct Point {
    // along the track of the reference point; below 0 and above the length where the body reaches beyond it
    double s_m = 0.0;
    Vec2 position_m, heading;  // of the travel
  };
  double length_m = 0.0;
  Footprint footprint;
  Box box;
  std::vector<Point> points;
  double step_m = 0.0;      // from one point to the next, at most
  bool bends = false;       // its curve is not one straight line
  bool tail_first = false;  // the nose points against the travel
  double centre_m = 0.0;    // of the body, from its reference point, along the travel

  static Track of(const Curve& curve, const Footprint& footprint);
  // A box that contains the points of such a track, and its curve; it is found without them. For a bend it is up to
  // half its length too large.
  static Box box_of(const Curve& curve, const Footprint& footprint);
  // How many of the points after one at this distance from something cannot be as near to it as `reach_m`.
  std::size_t points_beyond(double distance_m, double reach_m) const {
    return distance_m > reach_m ? static_cast<std::size_t>((distance_m - reach_m) / step_m) : 0;
  }
  OrientedRectangle body_at(const Point& point) const {
    return placed(footprint, {point.position_m, tail_first ? Vec2(-point.heading) : point.heading});
  }
};

// How two drives meet, judged where their tracks come closest. No kind if the tracks stay `margin_m` and half their
// widths apart, or if the tracks only separate.
//   head-on:   the tracks run against each other there (more than 120 degrees apart);
//   following: the tracks run in the same direction (less than 60 degrees apart), or one AGV enters the place that the
//              other leaves;
//   merging:   the tracks come from different sides and continue in the same direction, or end at the same place;
//   crossing:  any other case.
struct Encounter {
  std::optional<EncounterKind> kind;
  bool bands_overlap = false;  // true only if tracks as wide as the bodies do: they need the same floor
};
Encounter encounter_of(const Track& a, const Track& b, double margin_m);
// True only if encounter_of() says `following` of two straight tracks: one begins beside the other, in its direction.
// `reach_m`: `margin_m` and half their widths.
bool surely_following(const MiddleLine& a, const MiddleLine& b, double reach_m);

}  // namespace fleetproof
