#pragma once

#include <gtest/gtest.h>

#include "core/clearance/relative_speed.hpp"
#include "tests/oracle/known_pairs.hpp"

// The detector against brute force, pair by pair.
namespace fleetproof::oracle {

inline constexpr double kThreshold_m = 0.10 - 1e-6;  // of both

// The detector finds the place on a Bezier curve to 1e-10 m, the oracle to 1e-12 m.
inline double rounding_m(const TrajectoryPair& pair) {
  return 1e-12 + (pair.a.on_bezier() ? 2e-10 : 0.0) + (pair.b.on_bezier() ? 2e-10 : 0.0);
}

struct Tally {
  std::uint64_t pairs = 0, violations = 0, touches = 0, within_10um = 0, at_start = 0, evaluations = 0, most = 0,
                speeds = 0;
};

inline void check_first(const TrajectoryPair& pair, std::optional<SimTime> found, const Lowest& low) {
  constexpr double kAccuracy_m = 1e-9;
  const double rounding = rounding_m(pair);
  constexpr Nanoseconds kAccuracy = 1'000;
  if (!found) {
    EXPECT_GE(low.clearance_m, kThreshold_m - kAccuracy_m - rounding) << "a missed violation";
    return;
  }
  const Nanoseconds at = to_ns(*found);
  const double there_m = clearance_m(pair, at);
  EXPECT_LT(there_m, kThreshold_m + rounding) << "an accusation above the threshold";
  const auto seen = first_below(pair, kThreshold_m);
  if (seen && std::abs(*seen - at) <= kAccuracy) return;
  // Elsewhere only where the clearance creeps along the threshold, and nothing deeper came before.
  EXPECT_NEAR(there_m, kThreshold_m, kAccuracy_m + rounding) << at << " where the clock saw " << seen.value_or(0);
  const auto deeper = first_below(pair, kThreshold_m - kAccuracy_m - rounding);
  if (deeper) {
    EXPECT_GE(*deeper, at - kAccuracy);
  }
}

inline void check_closest(const TrajectoryPair& pair, const ApproachBelow& approach, const Lowest& low) {
  constexpr double kAccuracy_m = 1e-7 + 1e-9;
  const ClosestApproach& closest = approach.closest;
  if (low.clearance_m == 0.0) {
    EXPECT_LE(closest.clearance_m, 1e-12);
    EXPECT_LE(clearance_m(pair, to_ns(closest.at)), rounding_m(pair));
    const Nanoseconds before = to_ns(closest.at) - (pair.a.on_bezier() || pair.b.on_bezier() ? 1'000 : 2);
    if (before >= pair.begin) {
      EXPECT_GT(clearance_m(pair, before), 0.0) << "not the first touch";
    }
    return;
  }
  EXPECT_NEAR(closest.clearance_m, low.clearance_m, kAccuracy_m);
  EXPECT_NEAR(clearance_m(pair, to_ns(closest.at)), closest.clearance_m, rounding_m(pair));
}

// The speed of the closest points at the closest instant, where the trajectories are smooth for a while.
inline void check_speed(const TrajectoryPair& pair, const Piece& a, const Piece& b, Nanoseconds at, Tally& tally) {
  constexpr Nanoseconds kAround = 50'000;
  constexpr double kAccuracy_mps = 1e-4, kFarEnough_m = 1e-4;
  if (at - kAround < pair.begin || at + kAround > pair.end || clearance_m(pair, at) < kFarEnough_m) return;
  for (const Trajectory* body : {&pair.a, &pair.b}) {
    if (body->joint_between(at - kAround, at + kAround)) return;
  }
  ++tally.speeds;
  const Speed seen = relative_speed(pair, at);
  const RelativeSpeed found = fleetproof::relative_speed(a, b, at_ns(at));
  EXPECT_NEAR(found.speed_mps, seen.speed_mps, kAccuracy_mps) << at;
  EXPECT_NEAR(found.normal_mps, seen.closing_mps, kAccuracy_mps) << at;
}

inline void check(const TrajectoryPair& pair, Tally& tally) {
  const OwnPiece a(pair.a), b(pair.b);
  const Interval common{at_ns(pair.begin), at_ns(pair.end)};
  EvaluationCount count, both;
  const auto first = fleetproof::first_below(a.piece, b.piece, common, kThreshold_m, count);
  const auto approach = approach_below(a.piece, b.piece, common, kThreshold_m, both);
  const Lowest low = lowest(pair);
  ++tally.pairs;
  tally.violations += first.has_value();
  tally.touches += low.clearance_m == 0.0;
  tally.within_10um += std::abs(low.clearance_m - kThreshold_m) < 1e-5;
  tally.at_start += first == common.begin;
  tally.evaluations += count.distance;
  tally.most = std::max({tally.most, count.distance, both.distance});
  check_first(pair, first, low);
  ASSERT_EQ(approach.has_value(), first.has_value());
  if (!approach) return;
  EXPECT_EQ(approach->first, *first);
  check_closest(pair, *approach, low);
  check_speed(pair, a.piece, b.piece, to_ns(approach->closest.at), tally);
  check_speed(pair, a.piece, b.piece, to_ns(approach->first), tally);
}

// `pairs` random pairs, every relation in turn; those tuned to the threshold are a seventh.
inline Tally check_many(std::uint64_t seed, int pairs, PairSource::Bodies bodies = PairSource::Bodies::Plain) {
  PairSource source(seed, bodies);
  Tally tally;
  for (int i = 0; i < pairs; ++i) {
    const auto relation = static_cast<Relation>(i % kRelations);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", pair " + std::to_string(i) + ", relation " +
                 std::to_string(i % kRelations));
    check(source.next(relation, kThreshold_m), tally);
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GE(tally.within_10um * 20, tally.pairs) << "at least 5 % within 10 micrometres of the threshold";
  EXPECT_GT(tally.violations * 4, tally.pairs);
  EXPECT_LT(tally.violations * 4, tally.pairs * 3);
  EXPECT_GT(tally.at_start * 10, tally.pairs);
  EXPECT_GT(tally.speeds * 5, tally.pairs);
  EXPECT_LE(tally.most, 500U);
  return tally;
}

}  // namespace fleetproof::oracle
