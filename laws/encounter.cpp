#include "laws/encounter.hpp"

#include <algorithm>
#include <cmath>

namespace fleetproof {

MiddleLine MiddleLine::of(const Curve& curve, const Footprint& footprint) {
  const Pose start = curve.pose_at(0.0);
  const double nose = curve.is_tail_first() ? -1.0 : 1.0;
  const Vec2 travel = nose * start.heading;
  const double first_m = nose * footprint.centre_ahead_m - 0.5 * footprint.length_m;
  return {start.position_m + first_m * travel, travel, curve.length_m() + footprint.length_m};
}

double MiddleLine::square_distance_m2(const Vec2& point_m) const {
  const Vec2 from_begin_m = point_m - begin_m;
  const double along_m = std::clamp(from_begin_m.dot(travel), 0.0, length_m);
  return (from_begin_m - along_m * travel).squaredNorm();
}

// Whether all of the other line is beyond an end of this one, or on one side of it.
bool MiddleLine::has_aside(const MiddleLine& other, double distance_m) const {
  const Vec2 first_m = other.begin_m - begin_m, last_m = other.end_m() - begin_m;
  const double along_1 = first_m.dot(travel), along_2 = last_m.dot(travel);
  if (std::min(along_1, along_2) > length_m + distance_m || std::max(along_1, along_2) < -distance_m) return true;
  const Vec2 left(-travel.y(), travel.x());
  const double aside_1 = first_m.dot(left), aside_2 = last_m.dot(left);
  return std::min(aside_1, aside_2) > distance_m || std::max(aside_1, aside_2) < -distance_m;
}

namespace {

constexpr double kStep_m = 0.4;   // between points of a track: well below any width
constexpr double kSameWay = 0.5;  // cosine of 60 degrees
constexpr double kRounding_m = 1e-6, kSurely_m = 1e-3;
constexpr double kBoxRounding_m = 1e-3;  // lengths and poses of curves are more accurate than that

struct Closest {
  double distance_m = 0.0;
  const Track::Point* a = nullptr;
  const Track::Point* b = nullptr;
  double first_a_m = 0.0, first_b_m = 0.0;  // where each first comes within reach of the other
};

std::optional<Closest> closest_points(const Track& a, const Track& b, double reach_m) {
  Closest closest{reach_m, nullptr, nullptr, 1e300, 1e300};
  for (const auto& p : a.points) {
    if (!b.box.grown(reach_m).overlaps({p.position_m, p.position_m})) continue;
    for (std::size_t i = 0; i < b.points.size(); ++i) {
      const auto& q = b.points[i];
      const double distance_m = (p.position_m - q.position_m).norm();
      if (distance_m >= reach_m) {
        i += b.points_beyond(distance_m, reach_m);
        continue;
      }
      closest.first_a_m = std::min(closest.first_a_m, p.s_m);
      closest.first_b_m = std::min(closest.first_b_m, q.s_m);
      if (distance_m < closest.distance_m) {
        closest.distance_m = distance_m;
        closest.a = &p;
        closest.b = &q;
      }
    }
  }
  if (closest.a == nullptr) return std::nullopt;
  return closest;
}

// Where the body is when it stands at the start or at the end.
bool at_start(const Track& track, double s_m) { return s_m <= track.centre_m + 0.5 * track.footprint.length_m; }
bool at_end(const Track& track, double s_m) {
  return s_m >= track.length_m + track.centre_m - 0.5 * track.footprint.length_m;
}

std::optional<EncounterKind> kind_of(const Track& a, const Track& b, const Closest& closest) {
  const double cosine = closest.a->heading.dot(closest.b->heading);
  const bool from_start = at_start(a, closest.a->s_m) || at_start(b, closest.b->s_m);
  const bool both_from_start = at_start(a, closest.a->s_m) && at_start(b, closest.b->s_m);
  if (cosine >= kSameWay) {
    const bool from_different_sides = !at_start(a, closest.first_a_m) && !at_start(b, closest.first_b_m);
    return from_different_sides ? EncounterKind::Merging : EncounterKind::Following;
  }
  if (both_from_start) return std::nullopt;
  if (cosine <= -kSameWay) return EncounterKind::HeadOn;
  if (from_start) return EncounterKind::Following;
  return at_end(a, closest.a->s_m) && at_end(b, closest.b->s_m) ? EncounterKind::Merging : EncounterKind::Crossing;
}

// Where the centre of the body is when its reference point is at the start of the track, along the travel.
double centre_of(const Curve& curve, const Footprint& footprint) {
  return (curve.is_tail_first() ? -1.0 : 1.0) * footprint.centre_ahead_m;
}

}  // namespace

Track Track::of(const Curve& curve, const Footprint& footprint) {
  Track track{curve.length_m(), footprint, {}, {}};
  track.bends = !curve.is_straight();
  track.tail_first = curve.is_tail_first();
  track.centre_m = centre_of(curve, footprint);
  const double first_m = track.centre_m - 0.5 * footprint.length_m, whole_m = track.length_m + footprint.length_m;
  const int steps = std::max(1, static_cast<int>(std::ceil(whole_m / kStep_m)));
  track.step_m = whole_m / steps + kRounding_m;
  track.points.reserve(static_cast<std::size_t>(steps) + 1);
  const Pose start = curve.pose_at(0.0);
  Pose pose = start;
  Vec2 travel = track.tail_first ? Vec2(-start.heading) : start.heading;
  for (int i = 0; i <= steps; ++i) {
    const double s_m = first_m + whole_m * i / steps;
    const double on_curve_m = std::clamp(s_m, 0.0, track.length_m);
    if (track.bends) {
      pose = curve.pose_at(on_curve_m);
      travel = track.tail_first ? Vec2(-pose.heading) : pose.heading;
    } else {
      pose.position_m = start.position_m + on_curve_m * travel;  // what pose_at() says, to the bit
    }
    track.points.push_back({s_m, pose.position_m + (s_m - on_curve_m) * travel, travel});
    track.box.add(track.points.back().position_m);
  }
  return track;
}

Box Track::box_of(const Curve& curve, const Footprint& footprint) {
  const double length_m = curve.length_m(), tail_m = centre_of(curve, footprint) - 0.5 * footprint.length_m,
               first_m = std::min(tail_m, 0.0), last_m = std::max(tail_m + footprint.length_m, 0.0) + length_m;
  const Pose start = curve.pose_at(0.0);
  const Vec2 travel = curve.is_tail_first() ? Vec2(-start.heading) : start.heading;
  Box box;
  if (curve.is_straight()) {
    box.add(start.position_m + first_m * travel);
    box.add(start.position_m + last_m * travel);
    return box.grown(kBoxRounding_m);
  }
  // The ways from a point of the curve to both ends are together at most as long as the curve. So the point is within
  // half the length of the middle between the ends.
  const double beyond_m = std::max({-first_m, last_m - length_m, 0.0});
  box.add(0.5 * (start.position_m + curve.pose_at(length_m).position_m));
  return box.grown(0.5 * length_m + beyond_m + kBoxRounding_m);
}

// The first point of a track lies beside the other one. The points of that are so dense that one of them is near, too.
// The drives run in one direction, and where one of them comes near the other first, it is at its start.
bool surely_following(const MiddleLine& a, const MiddleLine& b, double reach_m) {
  if (a.travel.dot(b.travel) < kSameWay) return false;
  const double surely_m = reach_m - kRounding_m;
  const double square_m2 = surely_m * surely_m - 0.25 * kStep_m * kStep_m;
  return b.square_distance_m2(a.begin_m) < square_m2 || a.square_distance_m2(b.begin_m) < square_m2;
}

Encounter encounter_of(const Track& a, const Track& b, double margin_m) {
  const double widths_m = 0.5 * (a.footprint.width_m + b.footprint.width_m), reach_m = widths_m + margin_m;
  if (!a.box.grown(reach_m).overlaps(b.box)) return {};
  const auto closest = closest_points(a, b, reach_m);
  if (!closest) return {};
  return {kind_of(a, b, *closest), closest->distance_m < widths_m - kSurely_m};
}

}  // namespace fleetproof
