// The highest speed of bodies that stay in contact while both move on, as they do where a contact stops nobody.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "core/base/random.hpp"
#include "core/base/tolerances.hpp"
#include "core/clearance/relative_speed.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::test::fastest_below_test {
namespace {

constexpr double kLongest_s = 6.0;

struct Moving {
  Curve curve;
  Piece piece;
};

// A drive along an arc or a straight line, a turn, or a rest, near the origin.
void move(Moving& moving, std::uint32_t entity, Draws& draws) {
  const double angle_rad = draws.uniform(0.0, 6.28);
  const Pose start{{draws.uniform(-1.0, 1.0), draws.uniform(-1.0, 1.0)}, {std::cos(angle_rad), std::sin(angle_rad)}};
  Piece piece = rest_piece(EntityId{entity}, {draws.uniform(0.8, 2.4), draws.uniform(0.5, 1.2)}, start, kStart);
  piece.end = at_seconds(kLongest_s);
  switch (draws.below(4)) {
    case 0:
      break;
    case 1:
      piece.manner = Manner::Turn;
      piece.turn_rad = draws.uniform(-3.0, 3.0);
      piece.profile = MotionProfile(std::abs(piece.turn_rad), TurnLimits{}.as_motion());
      break;
    default:
      moving.curve = Curve({Arc{start, draws.uniform(1.0, 4.0), draws.below(2) == 0 ? 0.0 : draws.uniform(-1.0, 1.0)}});
      piece.manner = Manner::Drive;
      piece.curve = &moving.curve;
      piece.profile = MotionProfile(moving.curve.length_m(), {});
  }
  if (piece.manner != Manner::Rest) piece.end = kStart + piece.profile.duration();
  moving.piece = piece;
}

TEST(FastestBelow, NoInstantOfAFineClockIsFaster) {
  constexpr int kInstants = 400;
  Draws draws(3);
  EvaluationCount count;
  std::size_t in_contact = 0, turning = 0;
  for (int i = 0; i < 1'500; ++i) {
    Moving one, other;
    move(one, 0, draws);
    move(other, 1, draws);
    const Piece &a = one.piece, &b = other.piece;
    Interval common{kStart, std::min(a.end, b.end)};
    const auto touch = first_below(a, b, common, kTouch_m, count);
    if (!touch) continue;
    common = {*touch, last_below(a, b, {*touch, common.end}, kTouch_m, count).value_or(*touch)};
    const RelativeSpeed found = fastest_below(a, b, common, kTouch_m, count);
    double highest_mps = 0.0;
    for (int k = 0; k <= kInstants; ++k) {
      const SimTime t = common.begin + (common.end - common.begin) * k / kInstants;
      if (clearance_m(a.body_at(t), b.body_at(t)) < kTouch_m)
        highest_mps = std::max(highest_mps, relative_speed(a, b, t).speed_mps);
    }
    // Between two samples of the search, the shared corners may move a little faster.
    ASSERT_GE(found.speed_mps, highest_mps - 0.01) << i;
    ASSERT_LE(found.speed_mps, highest_mps + 0.05) << i;
    in_contact += highest_mps > 0.0 ? 1 : 0;
    turning += highest_mps > 0.0 && !(a.keeps_heading() && b.keeps_heading()) ? 1 : 0;
  }
  EXPECT_GT(in_contact, 1'000U);
  EXPECT_GT(turning, 600U);
}

// The time in which two bodies are in contact, from their first touch on; nothing if they do not touch.
std::optional<Interval> contact_of(const Piece& a, const Piece& b) {
  EvaluationCount count;
  const Interval common{kStart, std::min(a.end, b.end)};
  const auto touch = first_below(a, b, common, kTouch_m, count);
  if (!touch) return std::nullopt;
  return Interval{*touch, last_below(a, b, {*touch, common.end}, kTouch_m, count).value_or(*touch)};
}

TEST(FastestBelow, ALimitBelowTheSpeedChangesNoBitOfIt) {
  Draws draws(11);
  EvaluationCount all, near, far;  // of the limit to the speed
  std::size_t matters = 0, others = 0;
  for (int i = 0; i < 1'500; ++i) {
    Moving one, other;
    move(one, 0, draws);
    move(other, 1, draws);
    const auto contact = contact_of(one.piece, other.piece);
    if (!contact) continue;
    const RelativeSpeed speed = fastest_below(one.piece, other.piece, *contact, kTouch_m, all);
    for (const double share : {0.3, 0.9, 0.999, 1.0, 1.001, 1.3, 2.0}) {
      const double from_mps = share * speed.speed_mps;
      const RelativeSpeed found =
          fastest_below(one.piece, other.piece, *contact, kTouch_m, share > 1.5 ? far : near, from_mps);
      if (speed.speed_mps >= from_mps) {
        ASSERT_EQ(found.speed_mps, speed.speed_mps) << i << " " << share;
        ASSERT_EQ(found.normal_mps, speed.normal_mps) << i << " " << share;
        ++matters;
      } else {
        ASSERT_LT(found.speed_mps, from_mps) << i << " " << share;
        ++others;
      }
    }
  }
  EXPECT_GT(matters, 3'000U);
  EXPECT_GT(others, 2'000U);
  EXPECT_LT(far.distance, all.distance / 2) << "it costs less";
}

}  // namespace
}  // namespace fleetproof::test::fastest_below_test
