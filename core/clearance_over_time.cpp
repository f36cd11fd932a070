#include "core/clearance_over_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/advancement.hpp"

namespace fleetproof {
namespace {

// Smallest clearance of a pair: local descents give an upper bound, advancement proves it or finds where it is undercut.
class ClosestSearch {
 public:
  ClosestSearch(const Piece& a, const Piece& b, double tolerance_m, EvaluationCount& count)
      : a_(a), b_(b), tolerance_m_(tolerance_m), count_(count) {}

  Hit run(const Hit& first, SimTime end) {
    best_ = first;
    descend(first, end);
    // Outward from the minimum, where the gap along the direction of closest approach is stationary: most often one jump to either side.
    prove(first.at);
    prove(end);
    if (best_.clearance_m > 0.0) return best_;
    const auto touch = advance(a_, b_, first.at, best_.at, std::numeric_limits<double>::denorm_min(), count_);
    return touch.value_or(best_);
  }

 private:
  Hit measure(SimTime t) {
    ++count_.distance;
    const Hit hit{t, separation(a_.body_at(t), b_.body_at(t)).clearance_m};
    if (hit.clearance_m < best_.clearance_m) best_ = hit;
    return hit;
  }

  // Makes sure of everything between the best instant and `until`.
  void prove(SimTime until) {
    while (best_.clearance_m > 0.0) {
      const auto lower = advance(a_, b_, best_.at, until, best_.clearance_m - tolerance_m_, count_);
      if (!lower) return;
      best_ = *lower;
      descend(*lower, until);
      prove(lower->at);
    }
  }

  // From an instant towards another, downhill to a local minimum.
  void descend(const Hit& from, SimTime to) {
    constexpr std::int64_t kFirstStep_ns = 16'000'000, kLeastStep_ns = 200'000;
    const int sense = to < from.at ? -1 : 1;
    const auto ahead = [&](SimTime t, std::int64_t step_ns) { return std::abs((to - t).count()) <= step_ns ? to : t + Duration{sense * step_ns}; };
    std::int64_t step_ns = kFirstStep_ns;
    std::array<Hit, 3> bracket{from, from, measure(ahead(from.at, step_ns))};
    while (bracket[2].clearance_m >= from.clearance_m) {
      if ((step_ns /= 4) < kLeastStep_ns) return;
      const Hit inner = measure(ahead(from.at, step_ns));
      if (inner.clearance_m < from.clearance_m) return narrow({from, inner, bracket[2]});
      bracket[2] = inner;
    }
    while (best_.clearance_m > 0.0 && bracket[2].at != to) {
      step_ns *= 2;
      bracket = {bracket[1], bracket[2], measure(ahead(bracket[2].at, step_ns))};
      if (bracket[2].clearance_m >= bracket[1].clearance_m) return narrow(bracket);
    }
  }

  // Parabolas through three instants of which the middle one is the lowest; halving where a parabola gains little ground.
  void narrow(std::array<Hit, 3> hits) {
    constexpr int kMost = 24;
    if (hits[2].at < hits[0].at) std::swap(hits[0], hits[2]);
    double width = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kMost && best_.clearance_m > 0.0; ++i) {
      const double before = to_seconds(hits[1].at - hits[0].at), behind = to_seconds(hits[2].at - hits[1].at);
      const double fall = (hits[0].clearance_m - hits[1].clearance_m) / before, rise = (hits[2].clearance_m - hits[1].clearance_m) / behind;
      const double bend = (fall + rise) / (before + behind), slope = rise - bend * behind;
      if (!(slope * slope > tolerance_m_ * bend)) return;  // the parabola promises less than a quarter of the tolerance
      const bool slow = before + behind > 0.7 * width;
      width = before + behind;
      const double shift_s = slow ? 0.5 * (behind > before ? behind : -before) : -0.5 * slope / bend;
      const SimTime t = hits[1].at + seconds(shift_s);
      if (t <= hits[0].at || t >= hits[2].at || t == hits[1].at) return;
      const Hit hit = measure(t);
      const bool lower = hit.clearance_m<hits[1].clearance_m, later = t> hits[1].at;
      if (lower) {
        hits = later ? std::array{hits[1], hit, hits[2]} : std::array{hits[0], hit, hits[1]};
      } else {
        hits[later ? 2 : 0] = hit;
      }
    }
  }

  const Piece& a_;
  const Piece& b_;
  double tolerance_m_;
  EvaluationCount& count_;
  Hit best_;
};

std::optional<SimTime> instant_of(const std::optional<Hit>& hit) { return hit ? std::optional(hit->at) : std::nullopt; }

}  // namespace

std::optional<SimTime> first_below(const Piece& a, const Piece& b, Interval within, double level_m, EvaluationCount& count) {
  if (within.end < within.begin) return std::nullopt;
  return instant_of(advance(a, b, within.begin, within.end, level_m, count));
}

std::optional<SimTime> last_below(const Piece& a, const Piece& b, Interval within, double level_m, EvaluationCount& count) {
  if (within.end < within.begin) return std::nullopt;
  return instant_of(advance(a, b, within.end, within.begin, level_m, count));
}

std::optional<ClosestApproach> closest_approach(const Piece& a, const Piece& b, Interval within, double below_m, EvaluationCount& count,
                                                double tolerance_m) {
  if (within.end < within.begin) return std::nullopt;
  const auto first = advance(a, b, within.begin, within.end, below_m, count);
  if (!first) return std::nullopt;
  if (first->clearance_m <= 0.0) return ClosestApproach{first->clearance_m, first->at};
  const Hit closest = ClosestSearch(a, b, tolerance_m, count).run(*first, within.end);
  return ClosestApproach{closest.clearance_m, closest.at};
}

}  // namespace fleetproof
