#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <vector>

#include "core/clearance/clearance_over_time.hpp"
#include "core/geometry/rotation.hpp"
#include "tests/support/at_seconds.hpp"

// Random pairs of pieces that meet or nearly meet.
namespace fleetproof::test {

struct MotionPair {
  Piece a, b;
  Interval common;
};

enum class PairKind {
  CrossingLines,
  LineAndArc,
  Arcs,
  Following,
  Lanes,
  TurnAndDrive,
  RestAndDrive,
  RestAndTurn,
  Chains,
  SameBend,
  CutShort
};

class PairMaker {
 public:
  explicit PairMaker(unsigned seed) : engine_(seed) {}

  MotionPair make(PairKind kind) {
    for (;;) {
      curves_.clear();
      MotionPair pair = draw(kind);
      pair.common = {std::max(pair.a.begin, pair.b.begin), std::min(pair.a.end, pair.b.end)};
      if (pair.common.begin >= pair.common.end) continue;
      if (pair.a.swept_box(pair.a.end).grown(0.05).overlaps(pair.b.swept_box(pair.b.end).grown(0.05)))
        return keep(pair);
    }
  }

  // The second body of a pair moved sideways until the pair's smallest clearance is near `clearance_m`; false if there
  // is no such place near.
  bool tune(MotionPair& pair, double clearance_m) {
    const Vec2 aside = unit_vector(in(-kPi, kPi));
    double low = 0.0, high = 6.0;
    if (sampled_minimum_m(moved(pair, low, aside)) > clearance_m ||
        sampled_minimum_m(moved(pair, high, aside)) < clearance_m)
      return false;
    for (int i = 0; i < 44; ++i) {
      const double middle = 0.5 * (low + high);
      (sampled_minimum_m(moved(pair, middle, aside)) < clearance_m ? low : high) = middle;
    }
    pair = moved(pair, high, aside);
    kept_.push_back(curves_);
    if (pair.b.curve != nullptr) pair.b.curve = &kept_.back().back();
    return true;
  }

  double in(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0.0, 1.0)(engine_);
  }
  bool chance(double share) { return in(0.0, 1.0) < share; }

 private:
  // Curves live as long as the maker.
  MotionPair keep(MotionPair pair) {
    for (Piece* piece : {&pair.a, &pair.b}) {
      if (piece->curve == nullptr) continue;
      kept_.push_back({*piece->curve});
      piece->curve = &kept_.back().front();
    }
    curves_.clear();
    return pair;
  }

  Piece drive(Curve curve, SimTime begin) {
    curves_.push_back(std::move(curve));
    Piece piece;
    piece.manner = Manner::Drive;
    piece.begin = begin;
    piece.curve = &curves_.back();
    piece.start = piece.curve->pose_at(0.0);
    piece.footprint = {1.8, 1.2};
    piece.profile = MotionProfile(piece.curve->length_m(), {});
    piece.end = begin + piece.profile.duration();
    return piece;
  }

  Piece turn(const Vec2& at, SimTime begin) {
    Piece piece;
    piece.manner = Manner::Turn;
    piece.begin = begin;
    piece.start = {at, unit_vector(in(-kPi, kPi))};
    piece.footprint = {1.8, 1.2};
    piece.turn_rad = in(-kPi, kPi);
    piece.profile = MotionProfile(std::abs(piece.turn_rad), {0.8, 0.6, 0.9});
    piece.end = begin + piece.profile.duration();
    return piece;
  }

  double length() { return chance(0.8) ? in(3.0, 5.0) : in(5.0, 20.0); }
  static Curve line(const Vec2& middle, double heading_rad, double length_m) {
    const Vec2 heading = unit_vector(heading_rad);
    return Curve({Arc{{middle - 0.5 * length_m * heading, heading}, length_m, 0.0}});
  }
  Curve arc(const Vec2& middle, double heading_rad) {
    const double radius_m = in(1.5, 4.0);
    Arc arc{{middle, unit_vector(heading_rad)}, 0.5 * kPi * radius_m, (chance(0.5) ? 1.0 : -1.0) / radius_m};
    arc.start.position_m -= arc.pose_at(0.5 * arc.length_m).position_m - middle;
    return Curve({arc});
  }
  Curve chain(const Vec2& middle, double heading_rad) {
    const Vec2 way = 2.5 * unit_vector(heading_rad), bend = 2.0 * left_of(unit_vector(heading_rad));
    return Curve::bezier(middle - way, middle + bend, middle - bend, middle + way);
  }

  MotionPair draw(PairKind kind) {
    const SimTime begin = at_seconds(20.0), other_begin = begin + seconds(in(-3.0, 3.0));
    const Vec2 here(in(0.0, 50.0), in(0.0, 50.0)), there = here + Vec2(in(-3.0, 3.0), in(-3.0, 3.0));
    const double heading = in(-kPi, kPi), other_heading = in(-kPi, kPi);
    const auto any = [&](const Vec2& at, double way, SimTime when) {
      return drive(chance(0.5) ? line(at, way, length()) : arc(at, way), when);
    };
    switch (kind) {
      case PairKind::CrossingLines:
        return {
            drive(line(here, heading, length()), begin), drive(line(there, other_heading, length()), other_begin), {}};
      case PairKind::LineAndArc:
        return {drive(line(here, heading, length()), begin), drive(arc(there, other_heading), other_begin), {}};
      case PairKind::Arcs:
        return {drive(arc(here, heading), begin), drive(arc(there, other_heading), other_begin), {}};
      case PairKind::Following: {
        const double length_m = length();
        return {drive(line(here, heading, length_m), begin + seconds(in(0.0, 4.0))),
                drive(line(here + in(0.0, 3.0) * unit_vector(heading), heading, length_m), begin),
                {}};
      }
      case PairKind::Lanes: {
        const double apart_m = chance(0.3) ? 1.3 + in(-50e-6, 50e-6) : in(1.0, 2.0);
        const Vec2 along = unit_vector(heading), beside = here + apart_m * left_of(along) + in(-2.0, 2.0) * along;
        return {drive(line(here, heading, length()), begin),
                drive(line(beside, chance(0.5) ? heading : heading + kPi, length()), other_begin),
                {}};
      }
      case PairKind::TurnAndDrive:
        return {turn(here, begin), any(here + 0.7 * (there - here), heading, other_begin), {}};
      case PairKind::RestAndDrive:
        return {rest_piece(EntityId{1U}, {1.8, 1.2}, {here, unit_vector(heading)}, kStart),
                any(there, other_heading, begin),
                {}};
      case PairKind::RestAndTurn:
        return {turn(here, begin),
                rest_piece(EntityId{1U}, {1.0, 0.6}, {here + 0.6 * (there - here), unit_vector(heading)}, kStart),
                {}};
      case PairKind::Chains:
        return {drive(chain(here, heading), begin), drive(chain(there, other_heading), other_begin), {}};
      case PairKind::SameBend: {
        Arc lead{{here, unit_vector(heading)}, 8.0, 1.0 / in(1.5, 4.0)};
        const Arc trail = lead;
        lead.start = trail.pose_at(in(2.0, 2.4));
        return {drive(Curve({trail}), begin),
                drive(Curve({lead}), chance(0.5) ? begin : begin - seconds(in(0.0, 0.5))),
                {}};
      }
      case PairKind::CutShort:
        break;
    }
    MotionPair pair{any(here, heading, begin), any(there, other_heading, other_begin), {}};
    pair.b.end = pair.b.begin + seconds(in(0.3, 0.9) * to_seconds(pair.b.profile.duration()));
    return pair;
  }

  MotionPair moved(const MotionPair& pair, double by_m, const Vec2& way) {
    MotionPair result = pair;
    result.b.start.position_m += by_m * way;
    if (pair.b.curve == nullptr) return result;
    curves_ = {pair.b.curve->moved(by_m * way)};
    result.b.curve = &curves_.back();
    return result;
  }

  static double sampled_minimum_m(const MotionPair& pair) {
    const auto at = [&](double t_s) {
      return clearance_m(pair.a.body_at(at_seconds(t_s)), pair.b.body_at(at_seconds(t_s)));
    };
    const double begin_s = to_seconds(pair.common.begin), end_s = to_seconds(pair.common.end);
    constexpr int kSamples = 200;
    double best_s = begin_s, least_m = at(begin_s);
    for (int i = 1; i <= kSamples; ++i) {
      const double t_s = begin_s + (end_s - begin_s) * i / kSamples, clearance = at(t_s);
      if (clearance < least_m) least_m = clearance, best_s = t_s;
    }
    double low = std::max(begin_s, best_s - 0.02), high = std::min(end_s, best_s + 0.02);
    for (int i = 0; i < 30; ++i) {
      const double p = low + (high - low) / 3.0, q = high - (high - low) / 3.0;
      (at(p) < at(q) ? high : low) = at(p) < at(q) ? q : p;
    }
    return std::min(least_m, at(0.5 * (low + high)));
  }

  std::mt19937_64 engine_;
  std::deque<Curve> curves_;
  std::deque<std::deque<Curve>> kept_;
};

}  // namespace fleetproof::test
