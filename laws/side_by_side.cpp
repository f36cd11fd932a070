#include "laws/side_by_side.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

constexpr double kAlong = 0.985;  // cosine of 10 degrees
constexpr double kSlack_m = 1e-6;
constexpr double kSurelyWithin_m = 1e-3;  // more than slack and rounding

// Of a point from a straight piece of a middle line.
struct Distance {
  double distance_m;
  bool is_beside;  // not before or behind it
};

Distance distance(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const double square = way.squaredNorm();
  const double share = square > 0.0 ? (p - a).dot(way) / square : -1.0;
  const double inside = std::clamp(share, 0.0, 1.0);
  return {(p - (a + inside * way)).norm(), share == inside};
}

struct Gaps {
  double bands_m = 1e300;  // smallest anywhere
  double along_m = 1e300;  // smallest where they run along each other, and not one behind the other
};

// From the points of one track to the middle line of the other one. False as soon as the bands overlap. Gaps of
// `matters_m` and more are left out where that is quicker.
bool measure(const Track& a, const Track& b, double within_m, double matters_m, Gaps& gaps) {
  const double widths_m = 0.5 * (a.footprint.width_m + b.footprint.width_m);
  const Box near = b.box.grown(widths_m + within_m);
  for (const auto& p : a.points) {
    if (!near.overlaps({p.position_m, p.position_m})) continue;
    for (std::size_t i = 0; i + 1 < b.points.size(); ++i) {
      const auto& q = b.points[i];
      const auto [distance_m, is_beside] = distance(p.position_m, q.position_m, b.points[i + 1].position_m);
      const double gap_m = distance_m - widths_m;
      if (gap_m < -kSlack_m) return false;
      gaps.bands_m = std::min(gaps.bands_m, gap_m);
      if (is_beside && std::abs(p.heading.dot(q.heading)) >= kAlong) gaps.along_m = std::min(gaps.along_m, gap_m);
      i += b.points_beyond(gap_m, matters_m);
    }
  }
  return true;
}

// Of the bodies, wherever they are on their tracks. The halves of a track beyond its ends are no places of a body.
double bodies_apart_m(const Track& a, const Track& b, double within_m) {
  double least_m = within_m;
  const double reach_m = within_m + a.footprint.reach_m() + b.footprint.reach_m();
  const auto is_place = [](const Track& track, const Track::Point& p) {
    return p.s_m >= 0.0 && p.s_m <= track.length_m;
  };
  for (const auto& p : a.points) {
    if (!is_place(a, p)) continue;
    const auto body = a.body_at(p);
    for (std::size_t i = 0; i < b.points.size(); ++i) {
      const auto& q = b.points[i];
      const double distance_m = (p.position_m - q.position_m).norm();
      if (distance_m > reach_m) i += b.points_beyond(distance_m, reach_m);
      if (!is_place(b, q) || distance_m > reach_m) continue;
      least_m = std::min(least_m, clearance_m(body, b.body_at(q)));
    }
  }
  return least_m;
}

}  // namespace

bool surely_not_side_by_side(const MiddleLine& a, const MiddleLine& b, double widths_m) {
  if (std::abs(a.travel.dot(b.travel)) < kAlong) return true;
  const double within_m = std::max(0.0, widths_m - kSurelyWithin_m), square_m2 = within_m * within_m;
  return b.square_distance_m2(a.begin_m) < square_m2 || a.square_distance_m2(b.begin_m) < square_m2 ||
         b.square_distance_m2(a.end_m()) < square_m2 || a.square_distance_m2(b.end_m()) < square_m2;
}

SideBySide side_by_side(const Track& a, const Track& b, double margin_m) {
  SideBySide met;
  const double widths_m = 0.5 * (a.footprint.width_m + b.footprint.width_m);
  const double ends_m = 0.5 * std::max(a.footprint.length_m, b.footprint.length_m);
  if (!a.box.grown(widths_m + kBesideACurve_m + ends_m).overlaps(b.box)) return met;
  Gaps gaps;
  const double within_m = kBesideACurve_m + ends_m;
  const double matters_m = std::max(margin_m, kTightGap_m) + 1e-3;
  if (!measure(a, b, within_m, matters_m, gaps) || !measure(b, a, within_m, matters_m, gaps)) return met;
  met.tight_gap = gaps.along_m <= kTightGap_m + kSlack_m;
  if (!a.bends && !b.bends) return met;
  const double bodies_m = bodies_apart_m(a, b, kBesideACurve_m + kSlack_m);
  met.curve_beside_lane = bodies_m <= kBesideACurve_m;
  met.overhang_pass = gaps.bands_m >= margin_m && bodies_m < margin_m;
  return met;
}

}  // namespace fleetproof
