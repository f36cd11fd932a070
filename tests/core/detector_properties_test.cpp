// What holds of the detector for any pair of pieces whatever.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdlib>

#include "tests/oracle/known_pairs.hpp"

namespace fleetproof::oracle::detector_properties_test {
namespace {

constexpr double kLevel_m = 0.10 - 1e-6;

// The same cases on every machine and every day, unless the environment says otherwise.
const bool kSeeded = setenv("RC_PARAMS", "seed=20261 max_success=400", 0) == 0;

TrajectoryPair any_pair() {
  PairSource source(*rc::gen::arbitrary<std::uint64_t>());
  return source.next(static_cast<Relation>(*rc::gen::inRange(0, kRelations)), kLevel_m);
}

struct Found {
  std::optional<ApproachBelow> approach;
  double at_first_m = 0.0;
};

Found find(const TrajectoryPair& pair, bool swapped = false, double level_m = kLevel_m) {
  const OwnPiece a(pair.a), b(pair.b);
  EvaluationCount count;
  const Interval common{at_ns(pair.begin), at_ns(pair.end)};
  Found found{swapped ? approach_below(b.piece, a.piece, common, level_m, count)
                      : approach_below(a.piece, b.piece, common, level_m, count)};
  if (found.approach)
    found.at_first_m =
        fleetproof::clearance_m(a.piece.body_at(found.approach->first), b.piece.body_at(found.approach->first));
  return found;
}

// The same verdict: the same instant within `within`, unless the clearance creeps along the level, and the same
// smallest clearance.
void expect_same(const Found& one, const Found& other, const TrajectoryPair& pair, Duration within, double accuracy_m) {
  if (!one.approach || !other.approach) {
    // One of them met a dip that is within the accuracy.
    if (one.approach || other.approach) RC_ASSERT(lowest(pair).clearance_m > kLevel_m - accuracy_m);
    return;
  }
  const bool same = std::chrono::abs(one.approach->first - other.approach->first) <= within;
  RC_ASSERT(same ||
            (std::abs(one.at_first_m - kLevel_m) < accuracy_m && std::abs(other.at_first_m - kLevel_m) < accuracy_m));
  const double smallest = one.approach->closest.clearance_m, smallest_too = other.approach->closest.clearance_m;
  RC_ASSERT((smallest <= 0.0 && smallest_too <= 0.0) || std::abs(smallest - smallest_too) < 1e-7 + accuracy_m);
}

bool holds(const char* name, void (*property)()) { return rc::check(name, property); }

TEST(DetectorProperties, SymmetricInThePair) {
  EXPECT_TRUE(holds("either body first", [] {
    const TrajectoryPair pair = any_pair();
    expect_same(find(pair), find(pair, true), pair, Duration{2}, 2e-9);
  }));
}

TEST(DetectorProperties, InvariantUnderRigidMotion) {
  EXPECT_TRUE(holds("turned and moved", [] {
    const TrajectoryPair pair = any_pair();
    TrajectoryPair moved = pair;
    const Point turn = direction(0.01 * *rc::gen::inRange(-314, 314)),
                shift{0.5 * *rc::gen::inRange(-100, 100), 0.5 * *rc::gen::inRange(-100, 100)};
    const auto turned = [&](Point p) { return Point{p.x * turn.x - p.y * turn.y, p.x * turn.y + p.y * turn.x}; };
    for (Trajectory* t : {&moved.a, &moved.b}) {
      t->at = turned(t->at) + shift, t->heading = turned(t->heading);
      for (Stroke& s : t->strokes) {
        if (s.bezier) {
          std::array<Point, 4> p = s.bezier->control_points();
          for (Point& q : p) q = turned(s.from + q) + shift;
          s = bezier_stroke(p);
        } else {
          s.from = turned(s.from) + shift, s.heading = turned(s.heading);
        }
      }
    }
    expect_same(find(pair), find(moved), pair, Duration{5}, 2e-9);
  }));
}

TEST(DetectorProperties, InvariantUnderTimeShiftToTheBit) {
  EXPECT_TRUE(holds("earlier or later", [] {
    const TrajectoryPair pair = any_pair();
    TrajectoryPair shifted = pair;
    const Nanoseconds by = *rc::gen::inRange<Nanoseconds>(-10'000'000'000, 100'000'000'000'000);
    for (Nanoseconds* t :
         {&shifted.a.begin, &shifted.a.end, &shifted.b.begin, &shifted.b.end, &shifted.begin, &shifted.end})
      *t += by;
    const auto one = find(pair).approach, other = find(shifted).approach;
    RC_ASSERT(one.has_value() == other.has_value());
    if (!one) return;
    RC_ASSERT(other->first - one->first == Duration{by});
    RC_ASSERT(other->closest.at - one->closest.at == Duration{by});
    RC_ASSERT(other->closest.clearance_m == one->closest.clearance_m);
  }));
}

TEST(DetectorProperties, MonotoneInTheThreshold) {
  EXPECT_TRUE(holds("a wider threshold is met no later", [] {
    const TrajectoryPair pair = any_pair();
    const double wider_m = kLevel_m + 1e-3 * *rc::gen::inRange(0, 500) + 1e-8;
    const Found narrow = find(pair), wide = find(pair, false, wider_m);
    if (!narrow.approach) return;
    RC_ASSERT(wide.approach.has_value());
    RC_ASSERT(wide.approach->first <= narrow.approach->first + Duration{1});
    RC_ASSERT(wide.approach->closest.clearance_m <= narrow.approach->closest.clearance_m + 1.1e-7 ||
              narrow.approach->closest.clearance_m <= 0.0);
  }));
}

TEST(DetectorProperties, WhatIsFoundLiesInTheIntervalInOrder) {
  EXPECT_TRUE(holds("within", [] {
    const TrajectoryPair pair = any_pair();
    const Found found = find(pair);
    if (!found.approach) return;
    RC_ASSERT(found.approach->first >= at_ns(pair.begin));
    RC_ASSERT(found.approach->closest.at >= found.approach->first);
    RC_ASSERT(found.approach->closest.at <= at_ns(pair.end));
    RC_ASSERT(found.approach->closest.clearance_m <= found.at_first_m);
    RC_ASSERT(found.at_first_m < kLevel_m);
  }));
}

}  // namespace
}  // namespace fleetproof::oracle::detector_properties_test
