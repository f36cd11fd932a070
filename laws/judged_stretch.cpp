#include "laws/judged_stretch.hpp"

#include <algorithm>
#include <cstdint>

#include "core/base/tolerances.hpp"

namespace fleetproof {
namespace {

class Judge {
 public:
  Judge(const Piece& a, const Piece& b, Interval within, EvaluationCount& count)
      : a_(a), b_(b), within_(within), count_(count) {}

  Stretch file(const ClosestApproach& found) {
    if (found.clearance_m < kTouch_m + kSmallestClearance_m) {
      if (const auto touch = first_touch()) return contact(*touch);
    }
    return near(found);
  }

 private:
  double clearance_at(SimTime t) {
    ++count_.distance;
    return clearance_m(a_.body_at(t), b_.body_at(t));
  }

  // The world measures where a piece begins, and looks for kTouch_m in between.
  std::optional<SimTime> first_touch() {
    if (clearance_at(within_.begin) < kTouch_m) return within_.begin;
    std::optional<SimTime> below = first_below(a_, b_, within_, kContact_m, count_);
    if (!below && clearance_at(within_.end) < kTouch_m) below = within_.end;
    if (!below) return std::nullopt;
    return first_below(a_, b_, {within_.begin, *below}, kTouch_m, count_).value_or(*below);
  }

  Stretch contact(SimTime touch) {
    const SimTime end = last_below(a_, b_, {touch, within_.end}, kTouch_m, count_).value_or(touch);
    return filed({clearance_at(touch), touch}, true, fastest_below(a_, b_, {touch, end}, kTouch_m, count_));
  }

  Stretch near(const ClosestApproach& found) {
    const double level_m = found.clearance_m + kSameClearance_m;
    const SimTime before = first_below(a_, b_, {within_.begin, found.at}, level_m, count_).value_or(found.at),
                  after = last_below(a_, b_, {found.at, within_.end}, level_m, count_).value_or(found.at);
    const SimTime first = bottom(before, after), last = std::max(first, bottom(after, first));
    return filed({clearance_at(first), first}, false,
                 fastest_below(a_, b_, {first, last}, clearance_at(first) + kSameClearance_m, count_));
  }

  // From an instant towards another: the first instant at which the clearance no longer falls.
  SimTime bottom(SimTime from, SimTime to) {
    const TimeSense sense = to < from ? TimeSense::Backward : TimeSense::Forward;
    const auto falls = [&](SimTime t) {
      ++count_.distance;
      return clearance_rate_mps(a_, b_, t, sense) < -kStationary_mps;
    };
    const std::int64_t all_ns = std::abs((to - from).count());
    const auto at = [&](std::int64_t ns) { return from + Duration{static_cast<int>(sense) * ns}; };
    if (all_ns == 0 || !falls(from)) return from;
    std::int64_t falling = 0, next = 1;
    while (next < all_ns && falls(at(next))) {
      falling = next;
      next *= 2;
    }
    next = std::min(next, all_ns);
    while (next - falling > 1) {
      const std::int64_t middle = falling + (next - falling) / 2;
      (falls(at(middle)) ? falling : next) = middle;
    }
    return at(next);
  }

  Stretch filed(const ClosestApproach& closest, bool touches, const RelativeSpeed& speed) const {
    Stretch stretch = stretch_of(a_, b_, within_.begin, within_.end, closest);
    stretch.contact = touches;
    stretch.speed = speed;
    return stretch;
  }

  const Piece& a_;
  const Piece& b_;
  Interval within_;
  EvaluationCount& count_;
};

}  // namespace

Stretch judged_stretch(const Piece& one, const Piece& other, SimTime first, SimTime last,
                       const ClosestApproach& closest, EvaluationCount& count) {
  return Judge(one, other, {first, last}, count).file(closest);
}

}  // namespace fleetproof
