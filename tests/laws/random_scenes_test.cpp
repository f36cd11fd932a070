// The exact law against brute force: random timelines, sampled every millisecond, with a distance of this file's own.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "core/clearance/clearance_over_time.hpp"
#include "tests/laws/timeline.hpp"

namespace fleetproof::test::random_scenes_test {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(1);
// Two bodies at 2 m/s on arcs of 0.7 m and more: a corner of one moves by less than this in the frame of the other.
constexpr double kFastest_mps = 14.0;
constexpr double kBetweenSamples_m = kFastest_mps * 0.5e-3;

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double within(double low, double high) { return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53; }
  bool one_in(std::uint64_t n) { return random_() % n == 0; }
  std::size_t below(std::size_t n) { return random_() % n; }

 private:
  std::mt19937_64 random_;
};

Curve random_curve(const Pose& from, Dice& dice) {
  const bool straight = dice.one_in(2);
  const double curvature_per_m = straight ? 0.0 : (dice.one_in(2) ? 1.0 : -1.0) / dice.within(0.7, 3.0);
  const Arc first{from, dice.within(0.5, 4.0), curvature_per_m};
  if (!dice.one_in(3)) return Curve({first});
  return Curve({first, Arc{first.pose_at(first.length_m), dice.within(0.5, 3.0), 0.0}});
}

void live(Timeline& body, SimTime end, Dice& dice) {
  while (body.now() < end) {
    const double now_s = to_seconds(body.now());
    switch (dice.below(4)) {
      case 0:
        body.wait_until(now_s + dice.within(0.0, 2.0));
        break;
      case 1:
        body.turn(dice.within(-3.0, 3.0));
        break;
      default:
        body.drive(random_curve(body.pose(), dice));
    }
    if (dice.one_in(8)) body.cut_short_at(dice.within(now_s, to_seconds(body.now())));
  }
}

Scene random_scene(std::uint64_t seed) {
  Dice dice(seed);
  Scene scene(10.0);
  const std::size_t bodies = 2 + dice.below(3);
  for (std::size_t i = 0; i < bodies; ++i) {
    const Vec2 heading = dice.one_in(2) ? unit_vector(kPi / 4.0 * static_cast<double>(dice.below(8)))
                                        : unit_vector(dice.within(-kPi, kPi));
    const Footprint footprint = dice.one_in(3) ? Footprint{1.0, 0.7} : Footprint{};
    Timeline& body = scene.agv({Vec2(dice.within(0.0, 9.0), dice.within(0.0, 9.0)), heading}, footprint);
    live(body, scene.end, dice);
  }
  return scene;
}

using Corners = std::array<Vec2, 4>;

Corners corners_of(const Pose& pose, const Footprint& footprint) {
  const Vec2 along = 0.5 * footprint.length_m * pose.heading;
  const Vec2 across = 0.5 * footprint.width_m * Vec2(-pose.heading.y(), pose.heading.x());
  return {pose.position_m + along + across, pose.position_m - along + across, pose.position_m - along - across,
          pose.position_m + along - across};
}

// Largest gap between the two shadows on the side directions of `one`; negative if they overlap on each.
double widest_gap(const Corners& one, const Corners& other) {
  double widest = -1e9;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec2 axis = (one[i + 1] - one[i]).normalized();
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (std::size_t k = 0; k < 4; ++k) {
      low[0] = std::min(low[0], axis.dot(one[k])), high[0] = std::max(high[0], axis.dot(one[k]));
      low[1] = std::min(low[1], axis.dot(other[k])), high[1] = std::max(high[1], axis.dot(other[k]));
    }
    widest = std::max({widest, low[1] - high[0], low[0] - high[1]});
  }
  return widest;
}

double from_corners_to_sides(const Corners& one, const Corners& other) {
  double least = 1e9;
  for (const Vec2& corner : one) {
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec2 side = other[(i + 1) % 4] - other[i];
      const double share = std::clamp(side.dot(corner - other[i]) / side.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (corner - other[i] - share * side).norm());
    }
  }
  return least;
}

double clearance_between(const Corners& one, const Corners& other) {
  const double gap = std::max(widest_gap(one, other), widest_gap(other, one));
  return gap <= 0.0 ? gap : std::min(from_corners_to_sides(one, other), from_corners_to_sides(other, one));
}

struct Sampled {
  double min_m = 1e9;
  SimTime min_at;
  SimTime touch_at = kForever;  // first sample in an overlap
  std::vector<Interval> below;  // runs of samples below the threshold
};

class BruteForce {
 public:
  BruteForce(const Scene& scene, double threshold_m) : threshold_m_(threshold_m) {
    for (const Timeline& body : scene.bodies) pieces_.push_back(body.until(scene.end));
    for (std::size_t b = 1; b < pieces_.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) pairs[{a, b}] = sample(a, b, scene.end);
    }
  }

  double clearance_at(std::size_t a, std::size_t b, SimTime t) const {
    return clearance_between(corners_at(a, t), corners_at(b, t));
  }

  // The smallest clearance near the smallest sample, to a micrometre or better.
  double refined_m(std::size_t a, std::size_t b) const {
    const Sampled& sampled = pairs.at({a, b});
    double least = sampled.min_m;
    for (SimTime t = std::max(kStart, sampled.min_at - kStep); t <= sampled.min_at + kStep;
         t += std::chrono::microseconds(2)) {
      if (t <= pieces_[a].back().end) least = std::min(least, clearance_at(a, b, t));
    }
    return least;
  }

  std::map<std::pair<std::size_t, std::size_t>, Sampled> pairs;

 private:
  const Piece& piece_at(std::size_t body, SimTime t) const {
    const auto& pieces = pieces_[body];
    std::size_t i = 0;
    while (pieces[i].end < t) ++i;
    return pieces[i];
  }

  Corners corners_at(std::size_t body, SimTime t) const {
    const Piece& piece = piece_at(body, t);
    return corners_of(piece.pose_at(t), piece.footprint);
  }

  // Ten micrometres less for a body that drives a curve.
  double allowed_m(std::size_t body, SimTime t) const {
    const Piece& piece = piece_at(body, t);
    return piece.manner == Manner::Drive && !piece.curve->is_straight() ? 10e-6 : 0.0;
  }

  Sampled sample(std::size_t a, std::size_t b, SimTime end) const {
    Sampled sampled;
    for (SimTime t = kStart; t <= end; t += kStep) {
      const Corners one = corners_at(a, t), other = corners_at(b, t);
      if ((one[0] + one[2] - other[0] - other[2]).norm() > 2.0 * (2.0 * 0.95 + 0.6))
        continue;  // farther than 0.5 m apart
      const double clearance_m = clearance_between(one, other);
      if (clearance_m < sampled.min_m) sampled.min_m = clearance_m, sampled.min_at = t;
      if (clearance_m <= 0.0) sampled.touch_at = std::min(sampled.touch_at, t);
      if (clearance_m >= threshold_m_ - allowed_m(a, t) - allowed_m(b, t)) continue;
      if (!sampled.below.empty() && sampled.below.back().end == t - kStep) {
        sampled.below.back().end = t;
      } else {
        sampled.below.push_back({t, t});
      }
    }
    return sampled;
  }

  double threshold_m_;
  std::vector<std::vector<Piece>> pieces_;
};

std::vector<Violation> of_pair(const LawResults& findings, std::size_t a, std::size_t b) {
  std::vector<Violation> violations;
  for (const Violation& violation : findings.violations) {
    if (violation.a.index() == a && violation.b.index() == b) violations.push_back(violation);
  }
  return violations;
}

// Every run of samples below the threshold lies in one episode, and begins and ends with it unless a graze between
// samples was joined to it.
void expect_episodes(const std::vector<Violation>& violations, const Sampled& sampled) {
  for (std::size_t i = 0; i < sampled.below.size(); ++i) {
    const Interval& below = sampled.below[i];
    const auto in = std::ranges::find_if(
        violations, [&](const Violation& v) { return v.first <= below.begin && below.end <= v.last; });
    ASSERT_NE(in, violations.end()) << to_seconds(below.begin);
    const bool apart = i > 0 && below.begin - sampled.below[i - 1].end > std::chrono::milliseconds(102);
    if (i == 0 || apart) {
      EXPECT_LT(below.begin - in->first, std::chrono::microseconds(1100));
    }
    if (i + 1 == sampled.below.size()) {
      EXPECT_LT(in->last - below.end, std::chrono::microseconds(1100));
    }
  }
}

// Closest instants of a pair's violations. Below zero the law looks no further than the touch.
void expect_closest(const BruteForce& brute, std::size_t a, std::size_t b, const std::vector<Violation>& violations) {
  const Sampled& sampled = brute.pairs.at({a, b});
  double least_um = 1e12;
  SimTime touch_at = kForever;
  for (const Violation& violation : violations) {
    const double there_um = 1e6 * brute.clearance_at(a, b, violation.closest_at);
    if (violation.contact) {
      EXPECT_EQ(violation.min_clearance_um, 0);
      EXPECT_LT(there_um, 1.0);
    } else {
      EXPECT_NEAR(static_cast<double>(violation.min_clearance_um), there_um, 1.01);
    }
    least_um = std::min(least_um, there_um);
    if (violation.contact) touch_at = std::min(touch_at, violation.closest_at);
  }
  EXPECT_LE(touch_at, sampled.touch_at);
  if (sampled.min_m <= 0.0 || violations.empty()) return;
  EXPECT_LE(least_um, 1e6 * brute.refined_m(a, b) + 0.2);
  EXPECT_GE(least_um, 1e6 * (sampled.min_m - kBetweenSamples_m));
}

void expect_agreement(std::uint64_t seed) {
  const Scene scene = random_scene(seed);
  const double threshold_m = scene.scenario.law.safety_distance_m - 1e-6;
  const LawResults findings = play(scene, "exact");
  const BruteForce brute(scene, threshold_m);
  double refined_m = 0.5, sampled_m = 0.5;
  for (const auto& [pair, sampled] : brute.pairs) {
    const auto [a, b] = pair;
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", bodies " << a << " and " << b);
    const auto violations = of_pair(findings, a, b);
    const double pair_m = brute.refined_m(a, b);
    refined_m = std::min(refined_m, pair_m);
    sampled_m = std::min(sampled_m, sampled.min_m);
    if (std::abs(pair_m - threshold_m) > 1e-3) {
      EXPECT_EQ(violations.empty(), pair_m >= threshold_m);
    }
    expect_episodes(violations, sampled);
    expect_closest(brute, a, b, violations);
  }
  const double found_m = findings.min_clearance_m.value_or(0.5);
  EXPECT_LE(found_m, std::max(refined_m, 0.0) + 1e-6) << seed;
  EXPECT_GE(found_m, sampled_m - kBetweenSamples_m) << seed;
}

TEST(RandomScenes, ExactLawAgreesWithBruteForce) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) expect_agreement(seed);
}

// The scenes are worth their time: violations, near misses and free ways all occur.
TEST(RandomScenes, AreOfEveryKind) {
  int violated = 0, near = 0, free = 0, many = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const LawResults findings = play(random_scene(seed), "exact");
    violated += !findings.violations.empty();
    many += findings.violations.size() > 2;
    near += findings.violations.empty() && findings.min_clearance_m;
    free += !findings.min_clearance_m;
  }
  EXPECT_GT(violated, 40);
  EXPECT_GT(near, 10);
  EXPECT_GT(free, 10);
  EXPECT_GT(many, 5);
}

TEST(RandomScenes, AnnouncementOrderChangesNoViolation) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Scene scene = random_scene(seed);
    const auto expected = play(scene, "exact").violations;
    EXPECT_EQ(play(scene, "exact", Order::Backwards).violations, expected) << seed;
    EXPECT_EQ(play(scene, "exact", Order::AllEndsFirst).violations, expected) << seed;
  }
}

}  // namespace
}  // namespace fleetproof::test::random_scenes_test
