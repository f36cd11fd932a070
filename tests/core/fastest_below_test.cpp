// The highest speed of bodies that stay in contact while both move on, as they do where a contact stops nobody.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/base/random.hpp"
#include "core/base/tolerances.hpp"
#include "core/clearance/relative_speed.hpp"
#include "core/clearance/speed_bounds.hpp"
#include "tests/support/at_seconds.hpp"

namespace fleetproof::test::fastest_below_test {
namespace {

using namespace shared_points;

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

// The search as its result is defined: all samples between the changes of the laws of motion, then thirds around the
// fastest of them, to the nanosecond. Nothing is left out. Requires: curves of one part.
class PlainSearch {
 public:
  PlainSearch(const Piece& a, const Piece& b) : a_(a), b_(b) {}

  RelativeSpeed within(Interval all) {
    consider(all.begin, all);
    const std::vector<SimTime> changes = changes_in(all);
    for (std::size_t i = 0; i + 1 < changes.size(); ++i) consider_phase({changes[i], changes[i + 1]});
    if (!is_steady() && fastest_mps_ > 0.0) narrow();
    return fastest_mps_ > 0.0 ? relative_speed(a_, b_, fastest_at_) : RelativeSpeed{};
  }
  std::uint64_t evaluations() const { return evaluations_; }

 private:
  bool is_steady() const { return a_.keeps_heading() && b_.keeps_heading(); }

  std::vector<SimTime> changes_in(Interval all) const {
    std::vector<SimTime> changes{all.begin, all.end};
    for (const Piece* piece : {&a_, &b_}) {
      if (piece->manner == Manner::Rest) continue;
      for (const Duration end : piece->profile.phase_ends()) {
        if (kStart + end > all.begin && kStart + end < all.end) changes.push_back(kStart + end);
      }
    }
    std::ranges::sort(changes);
    changes.erase(std::unique(changes.begin(), changes.end()), changes.end());
    return changes;
  }

  void consider_phase(Interval phase) {
    const Duration step = std::max((phase.end - phase.begin) / (is_steady() ? 1 : 64), Duration{1});
    const auto near = [&](SimTime t) { consider(t, {std::max(phase.begin, t - step), std::min(phase.end, t + step)}); };
    for (SimTime t = phase.begin + Duration{1}; t < phase.end; t += step) near(t);
    near(phase.end - Duration{1});
    near(phase.end);
  }

  void consider(SimTime t, Interval around) {
    if (offer(t)) around_ = around;
  }

  void narrow() {
    Interval left = around_;
    while (left.end - left.begin > Duration{2}) {
      const Duration third = (left.end - left.begin) / 3;
      const SimTime low = left.begin + third, high = left.end - third;
      const bool rises = speed_mps(low) < speed_mps(high);
      offer(low);
      offer(high);
      (rises ? left.begin : left.end) = rises ? low : high;
    }
  }

  bool offer(SimTime t) {
    ++evaluations_;
    const double here_mps = speed_mps(t);
    if (here_mps <= fastest_mps_) return false;
    fastest_mps_ = here_mps;
    fastest_at_ = t;
    return true;
  }

  double speed_mps(SimTime t) const {
    return clearance_m(a_.body_at(t), b_.body_at(t)) < kTouch_m ? relative_speed(a_, b_, t).speed_mps : 0.0;
  }

  const Piece& a_;
  const Piece& b_;
  double fastest_mps_ = 0.0;
  SimTime fastest_at_ = kStart;
  Interval around_;
  std::uint64_t evaluations_ = 0;
};

TEST(FastestBelow, WhatIsLeftOutChangesNoBitOfTheSpeed) {
  Draws draws(17);
  std::uint64_t plain = 0;
  EvaluationCount count;
  int turning = 0;
  for (int i = 0; i < 500; ++i) {
    Moving one, other;
    move(one, 0, draws);
    move(other, 1, draws);
    const auto contact = contact_of(one.piece, other.piece);
    if (!contact) continue;
    PlainSearch search(one.piece, other.piece);
    const RelativeSpeed expected = search.within(*contact);
    const RelativeSpeed found = fastest_below(one.piece, other.piece, *contact, kTouch_m, count);
    ASSERT_EQ(found.speed_mps, expected.speed_mps) << i;
    ASSERT_EQ(found.normal_mps, expected.normal_mps) << i;
    plain += search.evaluations();
    turning += one.piece.keeps_heading() && other.piece.keeps_heading() ? 0 : 1;
  }
  EXPECT_GT(turning, 250);
  EXPECT_LT(5 * count.distance, 2 * plain) << "it costs less";
}

// Of two bodies, each in one phase of its law of motion: no instant of a fine clock reaches what the tracks call
// slower.
TEST(FastestBelow, TracksOfSharedPointsAreBounds) {
  constexpr int kInstants = 40;
  Draws draws(23);
  int settled = 0, falling = 0;
  for (int i = 0; i < 3'000; ++i) {
    Moving one, other;
    move(one, 0, draws);
    move(other, 1, draws);
    const Piece &a = one.piece, &b = other.piece;
    const SimTime begin = at_seconds(draws.uniform(0.01, 2.0));
    const PhaseMotion of_a = motion_from(a, a.body_at(begin), begin, kForever, TimeSense::Forward),
                      of_b = motion_from(b, b.body_at(begin), begin, kForever, TimeSense::Forward);
    const SimTime end = std::min({begin + seconds(draws.uniform(0.02, 0.3)), of_a.change, of_b.change});
    if (end - begin < seconds(0.01)) continue;
    const auto speed_mps = [&](SimTime t) {
      return clearance_m(a.body_at(t), b.body_at(t)) < kTouch_m ? relative_speed(a, b, t).speed_mps : 0.0;
    };
    double inside_mps = 0.0;
    for (int k = 1; k < kInstants; ++k)
      inside_mps = std::max(inside_mps, speed_mps(begin + (end - begin) * k / kInstants));
    if (inside_mps == 0.0) continue;
    const auto glimpse = [&](SimTime t) {
      const Meeting meeting(a, b, t);
      return Glimpse(meeting, Views(meeting.a.body, meeting.b.body));
    };
    const Glimpse from = glimpse(begin), to = glimpse(end);
    const SharedTracks tracks(from, to, Tops(of_a), Tops(of_b), to_seconds(end - begin));
    ASSERT_FALSE(tracks.all_slower(inside_mps)) << i;
    settled += tracks.all_slower(1.02 * inside_mps) ? 1 : 0;
    for (const bool at_begin : {true, false}) {
      const double peak_mps = speed_mps(at_begin ? begin : end);
      if (!tracks.all_slower(peak_mps, at_begin ? SharedTracks::Peak::Begin : SharedTracks::Peak::End)) continue;
      ASSERT_LT(inside_mps, peak_mps) << i;
      ++falling;
    }
  }
  EXPECT_GT(settled, 300);
  EXPECT_GT(falling, 200);
}

}  // namespace
}  // namespace fleetproof::test::fastest_below_test
