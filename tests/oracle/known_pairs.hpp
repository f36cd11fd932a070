#pragma once

#include <memory>
#include <random>

#include "core/clearance/clearance_over_time.hpp"
#include "core/geometry/arc.hpp"
#include "tests/oracle/brute_force.hpp"

// Random pairs of trajectories, and the same as pieces of the program under test.
namespace fleetproof::oracle {

enum class Relation { Crossing, Following, HeadOn, Parallel, Tangent, StartsInViolation, CutShort };
inline constexpr int kRelations = 7;
enum class Path { Straight, Arc, Bezier, Turn, Rest };

inline Vec2 vec(Point p) { return {p.x, p.y}; }
inline Point point(const Vec2& v) { return {v.x(), v.y()}; }

// Owns the curve of a piece.
struct OwnPiece {
  Piece piece;
  std::unique_ptr<Curve> curve;

  explicit OwnPiece(const Trajectory& t) {
    piece.begin = at_ns(t.begin), piece.end = at_ns(t.end);
    piece.footprint = {t.body_length, t.body_width, t.ahead};
    piece.start = {vec(t.at), vec(t.heading)};
    if (t.manner == Manner::Rest) return;
    piece.manner = t.manner == Manner::Turn ? fleetproof::Manner::Turn : fleetproof::Manner::Drive;
    piece.turn_rad = t.turn_rad;
    double way = std::abs(t.turn_rad);
    if (t.manner == Manner::Drive) {
      std::vector<Curve> curves;
      for (const Stroke& s : t.strokes) curves.push_back(curve_of(s));
      curve = std::make_unique<Curve>(Curve::joined(curves));
      if (t.tail_first) *curve = curve->tail_first();
      piece.curve = curve.get();
      piece.start = curve->pose_at(0.0);
      way = curve->length_m();
    }
    piece.profile = MotionProfile(way, {t.limits.speed, t.limits.acceleration, t.limits.deceleration});
  }

  static Curve curve_of(const Stroke& s) {
    if (!s.bezier) return Curve({Arc{{vec(s.from), vec(s.heading)}, s.length, s.curvature}});
    const auto& p = s.bezier->control_points();
    return Curve::bezier(vec(s.from), vec(s.from + p[1]), vec(s.from + p[2]), vec(s.from + p[3]));
  }
};

class PairSource {
 public:
  // Odd bodies drive tail first as often as not, and their centres need not be where they turn.
  enum class Bodies { Plain, Odd };
  explicit PairSource(std::uint64_t seed, Bodies bodies = Bodies::Plain) : random_(seed), bodies_(bodies) {}

  // A pair whose bodies come at least near each other; `level_m` is what tangents are tuned to and what violations at
  // the start lie below.
  TrajectoryPair next(Relation relation, double level_m) {
    for (;;) {
      TrajectoryPair pair = draw(relation);
      if (!in_common(pair)) continue;
      if (relation == Relation::Tangent &&
          !tune(pair, level_m + either(1.0) * std::pow(10.0, one_in(3) ? within(-5.0, -2.0) : within(-9.0, -5.0))))
        continue;
      if (relation == Relation::StartsInViolation && !(clearance_m(pair, pair.begin) < level_m)) continue;
      if (clearance_m(pair, pair.begin + (pair.end - pair.begin) / 2) < 3.0) return pair;
    }
  }

  double within(double low, double high) { return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53; }
  bool one_in(std::uint64_t n) { return random_() % n == 0; }
  double either(double size) { return one_in(2) ? size : -size; }

  static void move(Trajectory& t, Point by) {
    t.at = t.at + by;
    for (Stroke& s : t.strokes) s.from = s.from + by;
  }

  static Trajectory drive(std::vector<Stroke> strokes, Nanoseconds begin, const Limits& limits) {
    Trajectory t;
    t.manner = Manner::Drive, t.begin = begin, t.limits = limits;
    t.strokes = std::move(strokes);
    double way = 0.0;
    for (const Stroke& s : t.strokes) way += s.length;
    finish(t, way);
    return t;
  }

 private:
  static void finish(Trajectory& t, double way) {
    t.profile = Trapezoid(way, t.limits);
    t.end = t.begin + static_cast<Nanoseconds>(std::llround(1e9 * t.profile.duration_s()));
  }

  static bool in_common(TrajectoryPair& pair) {
    pair.begin = std::max(pair.a.begin, pair.b.begin), pair.end = std::min(pair.a.end, pair.b.end);
    return pair.begin < pair.end;
  }

  // b moved aside until the smallest clearance is `target_m`.
  bool tune(TrajectoryPair& pair, double target_m) {
    const Point aside = direction(within(-3.2, 3.2));
    const auto moved = [&](double by_m) {
      TrajectoryPair result = pair;
      move(result.b, by_m * aside);
      return result;
    };
    double low = 0.0, high = 6.0;
    if (roughly_lowest_m(moved(low)) > target_m || roughly_lowest_m(moved(high)) < target_m) return false;
    while (high - low > 1e-12) {
      const double middle = 0.5 * (low + high);
      (roughly_lowest_m(moved(middle)) < target_m ? low : high) = middle;
    }
    pair = moved(high);
    return true;
  }

  double way_m() { return one_in(5) ? within(5.0, 20.0) : within(3.0, 5.0); }
  Limits any_limits() { return one_in(3) ? Limits{within(0.5, 2.5), within(0.3, 1.5), within(0.3, 2.0)} : Limits{}; }

  std::vector<Stroke> strokes(Path path, Point middle, double angle_rad, double length_m) {
    const Point nose = direction(angle_rad);
    if (path == Path::Straight) return {{middle - 0.5 * length_m * nose, nose, length_m, 0.0}};
    if (path == Path::Arc) {
      const double radius_m = within(1.5, 4.0);
      return {{middle - 0.6 * radius_m * nose, nose, within(0.8, 1.6) * radius_m, either(1.0 / radius_m)}};
    }
    const Point bend = either(within(0.5, 2.5)) * left_of(nose), way = 2.5 * nose;
    const std::array<Point, 4> p{middle - way, middle + bend, middle - within(0.2, 1.0) * bend, middle + way};
    if (!one_in(4)) return {bezier_stroke(p)};
    // A chain of arcs of the program under test: its arcs, not their evaluation, are what is known of the trajectory.
    std::vector<Stroke> all;
    for (const Arc& arc : biarc_chain({vec(p[0]), vec(p[1]), vec(p[2]), vec(p[3])}, {1e-3, 0.1}))
      all.push_back({point(arc.start.position_m), point(arc.start.heading), arc.length_m, arc.curvature_per_m});
    return all;
  }

  Trajectory any(Path path, Point middle, double angle_rad, Nanoseconds begin) {
    if (path != Path::Turn && path != Path::Rest)
      return drive(strokes(path, middle, angle_rad, way_m()), begin, any_limits());
    Trajectory t;
    t.begin = begin, t.at = middle, t.heading = direction(angle_rad);
    t.end = begin + 6'000'000'000;
    if (path == Path::Rest) return t;
    t.manner = Manner::Turn, t.limits = {within(0.4, 1.2), within(0.4, 1.2), within(0.4, 1.2)};
    t.turn_rad = either(within(0.3, 3.2));
    finish(t, std::abs(t.turn_rad));
    return t;
  }

  Nanoseconds instant(double low_s, double high_s) {
    return static_cast<Nanoseconds>(within(1e9 * low_s, 1e9 * high_s));
  }
  Path any_path() { return static_cast<Path>(random_() % 5); }
  Path driven_path() { return static_cast<Path>(random_() % 3); }

  void dress(TrajectoryPair& pair) {
    for (Trajectory* t : {&pair.a, &pair.b}) {
      if (one_in(3)) t->body_length = within(0.5, 2.0), t->body_width = one_in(3) ? t->body_length : within(0.3, 1.5);
      if (bodies_ == Bodies::Plain) continue;
      t->tail_first = t->manner == Manner::Drive && one_in(2);
      t->ahead = one_in(4) ? 0.0 : within(-0.9, 0.9);
    }
  }

  TrajectoryPair draw(Relation relation) {
    const Point here{within(0.0, 50.0), within(0.0, 50.0)};
    const double angle_rad = within(-3.2, 3.2);
    TrajectoryPair pair;
    if (relation == Relation::Following || relation == Relation::HeadOn || relation == Relation::Parallel) {
      pair = on_one_track(relation, here, angle_rad);
    } else {
      const Path path = any_path();
      const Point there = here + Point{within(-3.0, 3.0), within(-3.0, 3.0)};
      pair.a = any(path, here, angle_rad, instant(20.0, 21.0));
      pair.b = any(path == Path::Rest ? driven_path() : any_path(), there, within(-3.2, 3.2), instant(18.0, 23.0));
    }
    if (relation == Relation::CutShort)
      pair.b.end =
          pair.b.begin + static_cast<Nanoseconds>(within(0.2, 0.9) * static_cast<double>(pair.b.end - pair.b.begin));
    if (relation != Relation::Parallel) dress(pair);
    return pair;
  }

  // Nearly parallel: the ends are, with the curvature there.
  static Stroke beside(const Stroke& s, double by_m) {
    const auto& p = s.bezier->control_points();
    const auto normal = [&](double t) {
      const Point along = s.bezier->tangent(t);
      return (1.0 / length(along)) * left_of(along);
    };
    const Point first = s.from + p[0] + by_m * normal(0.0), last = s.from + p[3] + by_m * normal(1.0);
    return bezier_stroke({first, first + (1.0 - by_m * s.bezier->bend_at(0.0)) * (p[1] - p[0]),
                          last - (1.0 - by_m * s.bezier->bend_at(1.0)) * (p[3] - p[2]), last});
  }

  TrajectoryPair on_one_track(Relation relation, Point here, double angle_rad) {
    const Path path = driven_path();
    const Limits limits = any_limits();
    const std::vector<Stroke> track = strokes(path, here, angle_rad, way_m());
    std::vector<Stroke> other = track;
    const Point nose = track[0].heading;
    if (relation == Relation::Following) {
      const Point ahead = within(1.5, 3.0) * nose;
      for (Stroke& s : other) s.from = s.from + ahead;
      return {drive(track, instant(20.0, 23.0), limits), drive(other, instant(19.5, 20.0), limits)};
    }
    // Beside it: the sides apart by the level, nearly the level, or anything.
    const double beside_m = 1.3 + (one_in(3) ? within(-50e-6, 50e-6) : one_in(4) ? -1e-6 : within(-0.3, 0.7));
    if (relation == Relation::HeadOn || one_in(3)) {
      other = {{here + beside_m * left_of(nose) + 0.5 * way_m() * nose, -1.0 * nose, way_m(), 0.0}};
    } else {
      for (Stroke& s : other) {
        if (s.bezier) {
          s = beside(s, beside_m);
          continue;
        }
        s.from = s.from + beside_m * left_of(s.heading);
        s.length *= 1.0 - beside_m * s.curvature;
        s.curvature /= 1.0 - beside_m * s.curvature;
        if (!(s.length > 0.05)) return {};
      }
    }
    return {drive(track, instant(20.0, 21.0), limits),
            drive(other, instant(19.0, 22.0), one_in(2) ? limits : any_limits())};
  }

  std::mt19937_64 random_;
  Bodies bodies_;
};

}  // namespace fleetproof::oracle
