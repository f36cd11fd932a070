#include "core/clearance/clearance_over_time.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "tests/core/motion_pairs.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::clearance_over_time_test {
namespace {

using test::MotionPair;
using test::PairKind;
using test::PairMaker;

constexpr double kLevel_m = 0.10;

// Distance between two rectangles from corners and sides alone, zero if they meet: nothing of the kernel's.
double side_distance_m(const OrientedRectangle& a, const OrientedRectangle& b) {
  const auto corners = [](const OrientedRectangle& r) {
    std::array<std::array<double, 2>, 4> c;
    constexpr std::array<double, 4> kAhead{1, -1, -1, 1}, kAside{1, 1, -1, -1};
    for (std::size_t i = 0; i < 4; ++i) {
      const double l = kAhead[i] * r.half_length_m, w = kAside[i] * r.half_width_m;
      c[i] = {r.centre_m.x() + l * r.heading.x() - w * r.heading.y(),
              r.centre_m.y() + l * r.heading.y() + w * r.heading.x()};
    }
    return c;
  };
  const auto p = corners(a), q = corners(b);
  // Squared distance from each corner of one to each side of the other; inside if left of all sides.
  const auto nearest = [](const auto& from, const auto& sides) {
    double least = 1e300;
    std::array<double, 4> per_square;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto &s = sides[i], &e = sides[(i + 1) % 4];
      per_square[i] = i < 2 ? 1.0 / ((e[0] - s[0]) * (e[0] - s[0]) + (e[1] - s[1]) * (e[1] - s[1])) : per_square[i - 2];
    }
    for (const auto& c : from) {
      bool inside = true;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto &s = sides[i], &e = sides[(i + 1) % 4];
        const double dx = e[0] - s[0], dy = e[1] - s[1], x = c[0] - s[0], y = c[1] - s[1];
        inside = inside && dx * y - dy * x > 0.0;
        const double t = std::clamp((x * dx + y * dy) * per_square[i], 0.0, 1.0);
        least = std::min(least, (x - t * dx) * (x - t * dx) + (y - t * dy) * (y - t * dy));
      }
      if (inside) return 0.0;
    }
    return least;
  };
  return std::sqrt(std::min(nearest(p, q), nearest(q, p)));
}

double brute_distance_m(const MotionPair& pair, SimTime t) {
  return side_distance_m(pair.a.body_at(t), pair.b.body_at(t));
}

// What a 10 us clock sees of a pair; it leaves out instants that no body can reach the level or a new minimum in, at
// kFastest_mps.
struct Seen {
  double least_m = 1e300;
  SimTime first = kForever, last = kForever;  // below the level
};

Seen look(const MotionPair& pair) {
  constexpr double kFastest_mps = 9.0;
  constexpr Duration kTick{10'000};
  Seen seen;
  for (SimTime t = pair.common.begin;;) {
    const double distance = brute_distance_m(pair, t);
    if (distance < kLevel_m) {
      if (seen.first == kForever) seen.first = t;
      seen.last = t;
    }
    const double idle_m = std::min(std::abs(distance - kLevel_m), std::max(0.0, distance - seen.least_m));
    seen.least_m = std::min(seen.least_m, distance);
    if (t == pair.common.end || distance == 0.0) return seen;
    t = std::min(pair.common.end, t + std::max(kTick, seconds(idle_m / kFastest_mps)));
  }
}

// Moves an instant below the level towards one at or above it (a tick away), to a nanosecond.
SimTime edge(const MotionPair& pair, SimTime below, Duration step) {
  SimTime above = std::clamp(below + step, pair.common.begin, pair.common.end);
  if (brute_distance_m(pair, above) < kLevel_m) return above;
  while (std::chrono::abs(above - below) > Duration{1}) {
    const SimTime middle = below + (above - below) / 2;
    (brute_distance_m(pair, middle) < kLevel_m ? below : above) = middle;
  }
  return below;
}

std::vector<MotionPair> test_pairs(PairMaker& maker) {
  std::vector<MotionPair> pairs;
  for (const PairKind kind : {PairKind::CrossingLines, PairKind::LineAndArc, PairKind::Arcs, PairKind::Following,
                              PairKind::Lanes, PairKind::TurnAndDrive, PairKind::RestAndDrive, PairKind::RestAndTurn,
                              PairKind::Chains, PairKind::SameBend, PairKind::CutShort}) {
    for (int i = 0; i < 20; ++i) pairs.push_back(maker.make(kind));
  }
  for (const PairKind kind : {PairKind::CrossingLines, PairKind::LineAndArc, PairKind::Arcs, PairKind::TurnAndDrive,
                              PairKind::RestAndTurn, PairKind::Chains, PairKind::CutShort}) {
    for (int i = 0; i < 15;) {
      MotionPair pair = maker.make(kind);
      const double beside_m = (maker.chance(0.5) ? 1.0 : -1.0) * std::pow(10.0, maker.in(-9.0, -3.0));
      if (!maker.tune(pair, kLevel_m + beside_m)) continue;
      pairs.push_back(pair);
      ++i;
    }
  }
  return pairs;
}

void expect_as_seen(const MotionPair& pair, const Seen& seen) {
  EvaluationCount count;
  const auto first = first_below(pair.a, pair.b, pair.common, kLevel_m, count),
             last = last_below(pair.a, pair.b, pair.common, kLevel_m, count);
  const auto closest = closest_approach(pair.a, pair.b, pair.common, kLevel_m, count);
  EXPECT_LE(count.distance, 300U);
  if (!first) {
    EXPECT_GE(seen.least_m, kLevel_m - 2e-9);
    EXPECT_FALSE(closest);
    return;
  }
  ASSERT_TRUE(closest);
  EXPECT_LT(brute_distance_m(pair, *first), kLevel_m + 1e-12);
  if (seen.least_m == 0.0) {
    EXPECT_LE(closest->clearance_m, 0.0);
  } else {
    EXPECT_NEAR(closest->clearance_m, seen.least_m, 1.1e-7);
    EXPECT_NEAR(brute_distance_m(pair, closest->at), closest->clearance_m, 1e-12);
  }
  if (seen.first == kForever) {
    EXPECT_GE(brute_distance_m(pair, *first), kLevel_m - 2e-9);  // fell between two ticks
    return;
  }
  const SimTime true_first = edge(pair, seen.first, Duration{-10'000});
  EXPECT_TRUE(std::chrono::abs(*first - true_first) <= Duration{1'000} ||
              brute_distance_m(pair, std::min(*first, true_first)) >= kLevel_m - 2e-9)
      << to_ns(*first) << " " << to_ns(true_first);
  if (seen.least_m == 0.0) return;  // the look ended there
  ASSERT_TRUE(last);
  EXPECT_LT(brute_distance_m(pair, *last), kLevel_m + 1e-12);
  const SimTime true_last = edge(pair, seen.last, Duration{10'000});
  EXPECT_TRUE(std::chrono::abs(*last - true_last) <= Duration{1'000} ||
              brute_distance_m(pair, std::max(*last, true_last)) >= kLevel_m - 2e-9)
      << to_ns(*last) << " " << to_ns(true_last);
}

TEST(ClearanceOverTime, AgreesWithBruteForce) {
  PairMaker maker(11);
  const std::vector<MotionPair> pairs = test_pairs(maker);
  EXPECT_GE(pairs.size(), 300U);
  int below = 0, within_10um = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    SCOPED_TRACE("pair " + std::to_string(i));
    const Seen seen = look(pairs[i]);
    below += seen.first != kForever;
    within_10um += std::abs(seen.least_m - kLevel_m) < 1e-5;
    ASSERT_NO_FATAL_FAILURE(expect_as_seen(pairs[i], seen));
    if (HasFailure()) break;
  }
  RecordProperty("below", below);
  RecordProperty("within_10um", within_10um);
  EXPECT_GT(below, 100);
  EXPECT_LT(below, 280);
  EXPECT_GT(within_10um, 40);
}

// Distance evaluations over many pairs.
class Costs {
 public:
  void add(const EvaluationCount& count) { spent_.push_back(count.distance); }
  double mean() const {
    return std::accumulate(spent_.begin(), spent_.end(), 0.0) / static_cast<double>(spent_.size());
  }
  std::uint64_t percentile(std::size_t percent) {
    std::ranges::sort(spent_);
    return spent_[std::min(spent_.size() - 1, spent_.size() * percent / 100)];
  }
  void record(const std::string& name) {
    testing::Test::RecordProperty(name + "_mean", std::to_string(mean()));
    testing::Test::RecordProperty(name + "_p99", std::to_string(percentile(99)));
    testing::Test::RecordProperty(name + "_max", std::to_string(percentile(100)));
  }

 private:
  std::vector<std::uint64_t> spent_;
};

// The mix of the performance targets, 12 000 pairs: six kinds in equal parts, the sixth tuned to a smallest clearance
// near the level; threshold 1 um below it.
template <class Spend>
void over_the_fixed_mix(Spend spend) {
  PairMaker maker(7);
  constexpr std::array kKinds{PairKind::CrossingLines, PairKind::LineAndArc, PairKind::Arcs, PairKind::Following,
                              PairKind::Lanes};
  for (int i = 0; i < 2'000; ++i) {
    for (const PairKind kind : kKinds) spend(maker.make(kind));
    for (bool tuned = false; !tuned;) {
      MotionPair pair = maker.make(kKinds[static_cast<std::size_t>(i) % 3]);
      tuned = maker.tune(pair, kLevel_m + (maker.chance(0.5) ? 1.0 : -1.0) * std::pow(10.0, maker.in(-7.0, -2.0)));
      if (tuned) spend(pair);
    }
  }
}

TEST(ClearanceOverTime, FewEvaluationsOnTheFixedMix) {
  Costs first, closest, both;
  over_the_fixed_mix([&](const MotionPair& pair) {
    EvaluationCount to_first, to_closest, to_both;
    first_below(pair.a, pair.b, pair.common, kLevel_m - 1e-6, to_first);
    first.add(to_first);
    if (closest_approach(pair.a, pair.b, pair.common, kLevel_m - 1e-6, to_closest)) closest.add(to_closest);
    approach_below(pair.a, pair.b, pair.common, kLevel_m - 1e-6, to_both);
    both.add(to_both);
  });
  first.record("first");
  closest.record("closest_of_violations");
  both.record("both");
  EXPECT_LE(first.mean(), 4.0);
  EXPECT_LE(first.percentile(99), 20U);
  EXPECT_LE(first.percentile(100), 500U);
  EXPECT_LE(closest.mean(), 8.0);
  EXPECT_LE(closest.percentile(100), 500U);
  EXPECT_LE(both.mean(), 8.0);
  EXPECT_LE(both.percentile(100), 500U);
}

class ClearanceInFigure4 : public ::testing::Test {
 protected:
  Piece drive(const Vec2& from, const Vec2& to, double begin_s) {
    curves_.push_back(Curve::straight(from, to));
    Piece piece;
    piece.manner = Manner::Drive;
    piece.begin = at_seconds(begin_s);
    piece.curve = &curves_.back();
    piece.start = piece.curve->pose_at(0.0);
    piece.footprint = {1.6, 1.0};
    piece.profile = MotionProfile(piece.curve->length_m(), {});
    piece.end = piece.begin + piece.profile.duration();
    return piece;
  }

  std::deque<Curve> curves_;
  EvaluationCount count_;
};

TEST_F(ClearanceInFigure4, AAndDViolateAsStated) {
  const Piece a = drive({0, 0}, {10, 0}, 2.0), d = drive({6.85, 2.39}, {6.85, 0.89}, 6.0);
  const Interval common{at_seconds(6.0), at_seconds(9.0)};
  const auto first = first_below(a, d, common, kLevel_m, count_), last = last_below(a, d, common, kLevel_m, count_);
  const auto closest = closest_approach(a, d, common, kLevel_m, count_);
  ASSERT_TRUE(first && last && closest);
  // On a clock of milliseconds the first instant below is 7.990 s and the last 8.129 s.
  EXPECT_GT(*first, at_seconds(7.989));
  EXPECT_LE(*first, at_seconds(7.990));
  EXPECT_GE(*last, at_seconds(8.129));
  EXPECT_LT(*last, at_seconds(8.130));
  EXPECT_NEAR(closest->clearance_m, 0.0148, 5e-5);
  EXPECT_NEAR(to_seconds(closest->at), 8.080, 1e-3);
  EXPECT_LE(count_.distance, 30U);
  // Either body first, the answer is the same.
  EXPECT_EQ(first_below(d, a, common, kLevel_m, count_), first);
}

TEST_F(ClearanceInFigure4, BAndCNearlyMiss) {
  const Piece b = drive({0, 4}, {0, 4 + 25.0 / 6.0}, 4.0),
              c = drive({1.39, 4 + 25.0 / 6.0}, {1.39 + 25.0 / 6.0, 4 + 25.0 / 6.0}, 7.0);
  const Interval common{at_seconds(7.0), at_seconds(9.0)};
  EXPECT_FALSE(first_below(b, c, common, kLevel_m, count_));
  const auto closest = closest_approach(b, c, common, 0.5, count_);
  ASSERT_TRUE(closest);
  EXPECT_NEAR(closest->clearance_m, 0.1267, 5e-5);
  EXPECT_NEAR(to_seconds(closest->at), 7.378, 1e-3);
}

TEST_F(ClearanceInFigure4, XPassesRestingYTooNear) {
  const Piece x = drive({0, 0}, {10, 0}, 0.0);
  Piece y = rest_piece(EntityId{1U}, {1.6, 1.0}, {{3, 1.35}, Vec2::UnitY()}, kStart);
  y.end = at_seconds(5.0);
  const Interval common{kStart, y.end};
  const auto first = first_below(x, y, common, kLevel_m, count_), last = last_below(x, y, common, kLevel_m, count_);
  const auto closest = closest_approach(x, y, common, kLevel_m, count_);
  ASSERT_TRUE(first && last && closest);
  EXPECT_NEAR(to_seconds(*first), 2.540, 5e-4);
  EXPECT_NEAR(to_seconds(*last), 4.193, 5e-4);
  EXPECT_NEAR(closest->clearance_m, 0.05, 1e-12);
}

TEST_F(ClearanceInFigure4, EdgesOfTheContract) {
  const Piece a = drive({0, 0}, {10, 0}, 0.0),
              wall = rest_piece(EntityId{1U}, {1.0, 4.0}, {{5.0, 0.0}, Vec2::UnitX()}, kStart);
  const Interval common{kStart, a.end};
  // Contact: front at 0.8 m ahead, wall's face at 4.5 m.
  const auto touch = first_below(a, wall, common, 0.0, count_);
  ASSERT_TRUE(touch);
  EXPECT_NEAR(static_cast<double>(to_ns(*touch)), 1e9 * a.profile.time_at(3.7), 2.0);
  // The wanted instants are within a nanosecond of the exact ones, whatever the level.
  for (const double level : {1e-6, 0.1, 0.5, 2.0}) {
    EXPECT_NEAR(static_cast<double>(to_ns(*first_below(a, wall, common, level, count_))),
                1e9 * a.profile.time_at(3.7 - level), 1.5);
    EXPECT_NEAR(static_cast<double>(to_ns(*last_below(a, wall, common, level, count_))),
                1e9 * a.profile.time_at(6.3 + level), 1.5);
  }
  const auto closest = closest_approach(a, wall, common, 0.1, count_);
  ASSERT_TRUE(closest);
  EXPECT_LE(closest->clearance_m, 0.0);
  EXPECT_NEAR(static_cast<double>(to_ns(closest->at)), static_cast<double>(to_ns(*touch)), 2.0);
  // Below from the start; an instant; an empty interval; nothing moves for ever.
  EXPECT_EQ(first_below(a, wall, {at_seconds(4.0), a.end}, 0.1, count_), at_seconds(4.0));
  EXPECT_EQ(first_below(a, wall, {at_seconds(4.0), at_seconds(4.0)}, 0.1, count_), at_seconds(4.0));
  EXPECT_FALSE(first_below(a, wall, {at_seconds(5.0), at_seconds(4.0)}, 0.1, count_));
  const Piece pillar = rest_piece(EntityId{2U}, {1.0, 1.0}, {{5.0, 20.0}, Vec2::UnitX()}, kStart);
  EvaluationCount one;
  EXPECT_FALSE(first_below(wall, pillar, {kStart, kForever}, 0.1, one));
  EXPECT_FALSE(last_below(wall, pillar, {kStart, kForever}, 0.1, one));
  EXPECT_EQ(one.distance, 2U);
}

// Straight along a wall, then a bend towards it: what a straight line would never do. Walked both ways.
TEST(ClearanceOverTime, SeesWhatComesAfterAJoint) {
  const Arc straight{{{0, 0}, Vec2::UnitX()}, 4.0, 0.0};
  const Arc bend{straight.pose_at(4.0), 0.5, 0.5};
  const Curve there({straight, bend}), back = there.reversed();
  const Piece wall = rest_piece(EntityId{1U}, {20.0, 1.0}, {{0, 1.3}, Vec2::UnitX()}, kStart);
  for (const Curve* curve : {&there, &back}) {
    Piece piece;
    piece.manner = Manner::Drive;
    piece.curve = curve;
    piece.profile = MotionProfile(curve->length_m(), {});
    piece.end = piece.begin + piece.profile.duration();
    const MotionPair pair{piece, wall, {piece.begin, piece.end}};
    const Seen seen = look(pair);
    ASSERT_NE(seen.first, kForever);
    ASSERT_GT(seen.least_m, 0.0);
    ASSERT_NO_FATAL_FAILURE(expect_as_seen(pair, seen));
    EXPECT_GT(clearance_m(piece.body_at(curve == &there ? piece.begin : piece.end), wall.body_at(kStart)), 0.29);
  }
}

// A post that a corner of the body passes closely where the curve bends. Each way, the bend has the other sign.
TEST(ClearanceOverTime, ACurveDrivenTheOtherWayBendsToTheOtherSide) {
  const Curve there = Curve::bezier({0, 0}, {2, 0}, {2, 0}, {2, 2}), back = there.reversed();
  for (const Vec2& place : {Vec2(0.97, -0.817), Vec2(-0.83, -0.617), Vec2(-0.43, -0.617), Vec2(2.37, -0.417),
                            Vec2(2.57, -0.217), Vec2(2.77, 0.183)}) {
    SCOPED_TRACE(place);
    const Piece post = rest_piece(EntityId{1U}, {0.2, 0.2}, {place, Vec2::UnitX()}, kStart);
    for (const Curve* curve : {&there, &back}) {
      Piece piece;
      piece.manner = Manner::Drive;
      piece.curve = curve;
      piece.profile = MotionProfile(curve->length_m(), {});
      piece.end = piece.begin + piece.profile.duration();
      const MotionPair pair{piece, post, {piece.begin, piece.end}};
      const Seen seen = look(pair);
      ASSERT_GT(seen.least_m, 0.0);
      ASSERT_NO_FATAL_FAILURE(expect_as_seen(pair, seen));
    }
  }
}

// Bodies that go round a bend together hardly move against each other: hours of evaluations if they were treated as two
// independent rotations.
TEST(ClearanceOverTime, PlatoonsOnABendAreCheap) {
  const Arc trail{{{0, 0}, Vec2::UnitX()}, 12.0, 0.5};
  const Arc lead{trail.pose_at(2.3), 12.0, 0.5};
  const Curve behind({trail}), ahead({lead});
  Piece a;
  a.manner = Manner::Drive;
  a.curve = &behind;
  a.profile = MotionProfile(12.0, {});
  a.end = a.begin + a.profile.duration();
  Piece b = a;
  b.curve = &ahead;
  const double apart_m = clearance_m(a.body_at(kStart), b.body_at(kStart));
  ASSERT_GT(apart_m, 0.05);
  EvaluationCount count;
  EXPECT_FALSE(first_below(a, b, {a.begin, a.end}, apart_m - 1e-7, count));
  const auto closest = closest_approach(a, b, {a.begin, a.end}, apart_m + 1e-3, count);
  ASSERT_TRUE(closest);
  EXPECT_NEAR(closest->clearance_m, apart_m, 1e-7);
  EXPECT_LE(count.distance, 20U);
}

}  // namespace
}  // namespace fleetproof::clearance_over_time_test
