#include "core/clearance/swept_region.hpp"

#include <algorithm>
#include <cmath>

namespace fleetproof {
namespace {

constexpr double kSweepRounding_m = 1e-6;
constexpr int kHalvings = 2;

// All points that are at most so far from a rectangle.
struct Region {
  OrientedRectangle rectangle;
  double beyond_m = 0.0;
};

// Where the reference point is on a curve: its ways to both ends are together as long as the part that is driven. So it
// lies in an ellipse about the chord.
Region of_bend(const Piece& piece, double begin_m, double end_m) {
  const Vec2 begin = piece.curve->pose_at(begin_m).position_m, chord_m = piece.curve->pose_at(end_m).position_m - begin;
  const double way_m = end_m - begin_m, square_m2 = chord_m.squaredNorm(), length_m = std::sqrt(square_m2);
  const Vec2 along = length_m > 0.0 ? Vec2(chord_m / length_m) : Vec2(Vec2::UnitX());
  return {{begin + 0.5 * chord_m, along, 0.5 * length_m, 0.0},
          0.5 * std::sqrt(std::max(0.0, way_m * way_m - square_m2)) + piece.footprint.reach_m()};
}

// What the body covers.
Region swept(const Piece& piece, Interval within) {
  if (piece.manner == Manner::Rest) return {placed(piece.footprint, piece.start)};
  if (piece.manner == Manner::Turn)
    return {{piece.start.position_m, Vec2::UnitX(), 0.0, 0.0}, piece.footprint.reach_m()};
  const double begin_m = piece.way_at(within.begin), end_m = piece.way_at(within.end);
  if (!piece.curve->is_straight()) return of_bend(piece, begin_m, end_m);
  OrientedRectangle body = placed(piece.footprint, piece.curve->pose_at(begin_m));
  const double half_m = 0.5 * (end_m - begin_m);
  body.centre_m += (piece.curve->is_tail_first() ? -half_m : half_m) * body.heading;
  body.half_length_m += half_m;
  return {body};
}

// What the bodies cover meets nowhere.
bool surely_apart(const Piece& a, const Piece& b, Interval within, double distance_m) {
  const Region first = swept(a, within), second = swept(b, within);
  const double beyond_m = first.beyond_m + second.beyond_m + distance_m + kSweepRounding_m;
  return clearance_m(first.rectangle, second.rectangle) > beyond_m;
}

}  // namespace

// The shorter the interval, the better the regions say where the bodies are.
std::optional<Interval> near_part(const Piece& a, const Piece& b, Interval within, double distance_m) {
  if (surely_apart(a, b, within, distance_m)) return std::nullopt;
  for (int halved = 0; halved < kHalvings; ++halved) {
    const SimTime middle = within.begin + (within.end - within.begin) / 2;
    const Interval early{within.begin, middle}, late{middle, within.end};
    if (surely_apart(a, b, early, distance_m)) {
      if (surely_apart(a, b, late, distance_m)) return std::nullopt;
      within = late;
    } else if (surely_apart(a, b, late, distance_m)) {
      within = early;
    } else {
      return within;
    }
  }
  return within;
}

}  // namespace fleetproof
