#include "core/clearance/closest_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/tolerances.hpp"
#include "core/clearance/gap_bound.hpp"

namespace fleetproof {
namespace {

TimeSense sense_of(SimTime from, SimTime to) { return to < from ? TimeSense::Backward : TimeSense::Forward; }
double seconds_between(SimTime s, SimTime t) { return std::abs(to_seconds(t - s)); }
SimTime after(SimTime t, double wait_s, SimTime to) {
  const Duration wait = seconds(wait_s);
  return to < t ? std::max(to, t - wait) : std::min(to, t + wait);
}

}  // namespace

Hit ClosestSearch::run(SimTime begin, const Hit& low, SimTime end) {
  best_ = low;
  if (below(0.0)) return low.at == begin ? low : advance(a_, b_, begin, low.at, kOverlap_m, count_).value_or(low);
  const Outlook ahead = outlook(low, end);
  if (ahead.touch) {
    if (const auto touch = advance(a_, b_, low, end, kOverlap_m, count_, Dating::Exact, best_)) return *touch;
    descend(best_, end);
  } else {
    descend(low, end);
  }
  // Outward from the minimum, where the gap along the direction of closest approach is stationary: most often one jump
  // to either side.
  prove(low.at);
  prove(end);
  if (!below(0.0)) return best_;
  Hit ignored = best_;
  return advance(a_, b_, low, best_.at, kOverlap_m, count_, Dating::Exact, ignored).value_or(best_);
}

Hit ClosestSearch::measure(SimTime t) {
  ++count_.distance;
  const Hit hit{t, separation(a_.body_at(t), b_.body_at(t))};
  if (!below(hit.apart.clearance_m)) best_ = hit;
  return hit;
}

double ClosestSearch::rate_mps(const Hit& hit, SimTime to) const {
  const TimeSense sense = sense_of(hit.at, to);
  const PhaseMotion first = motion_from(a_, a_.body_at(hit.at), hit.at, to, sense),
                    second = motion_from(b_, b_.body_at(hit.at), hit.at, to, sense);
  return GapBound(first, second, Axis(hit.apart, first, second)).trend().rate_mps;
}

ClosestSearch::Outlook ClosestSearch::outlook(const Hit& from, SimTime to) const {
  const TimeSense sense = sense_of(from.at, to);
  Axis axis;
  for (SimTime t = from.at; t != to;) {
    const PhaseMotion first = motion_from(a_, a_.body_at(t), t, to, sense),
                      second = motion_from(b_, b_.body_at(t), t, to, sense);
    if (t == from.at) axis = Axis(from.apart, first, second);
    const auto [value, rate, bend] = GapBound(first, second, axis).trend();
    if (value <= 0.0) return {t, true};
    if (rate >= 0.0) return {t};
    const SimTime change =
        sense == TimeSense::Forward ? std::min(first.change, second.change) : std::max(first.change, second.change);
    const double left_s = seconds_between(t, change), turn_s = bend > 0.0 ? -rate / bend : left_s,
                 x = std::min(turn_s, left_s);
    if (value + x * (rate + 0.5 * x * bend) <= 0.0) return {after(t, x, change), true};
    if (turn_s < left_s) return {after(t, turn_s, change)};
    t = change;
  }
  return {to};
}

// From an instant towards another, downhill to a local minimum.
void ClosestSearch::descend(const Hit& from, SimTime to) {
  constexpr int kMost = 24;
  Sample here{from, rate_mps(from, to)};
  for (int i = 0; i < kMost && here.hit.at != to && here.rate_mps < 0.0; ++i) {
    const SimTime t = outlook(here.hit, to).at;
    if (t == here.hit.at) return;
    const Hit hit = measure(t);
    if (below(0.0)) return;
    const Sample next{hit, rate_mps(hit, to)};
    if (next.rate_mps >= 0.0 || next.clearance_m() > here.clearance_m()) return narrow(here, next, to);
    if (-next.rate_mps * seconds_between(here.hit.at, t) < 0.1 * tolerance_m_) return;
    here = next;
  }
}

// Between a falling instant and one beyond the minimum: cubics through values and rates, tangents where a cubic gains
// little ground (a kink), then halves.
void ClosestSearch::narrow(Sample left, Sample right, SimTime to) {
  constexpr int kMost = 24;
  int slow = 0;
  for (int i = 0; i < kMost && !below(0.0); ++i) {
    const double width = seconds_between(left.hit.at, right.hit.at), fall = left.rate_mps, rise = right.rate_mps;
    double x = 0.5 * width;
    if (rise > 0.0) {
      // The clearance is not convex, but nearly. Therefore the point where the tangents meet is a fair estimate of the
      // possible gain.
      const double kink = (right.clearance_m() - left.clearance_m() - rise * width) / (fall - rise);
      if (kink > 0.0 && kink < width) {
        if (left.clearance_m() + fall * kink > best_.apart.clearance_m - 0.25 * tolerance_m_) return;
        if (slow == 1) x = kink;
      }
      const double d1 = fall + rise - 3.0 * (right.clearance_m() - left.clearance_m()) / width,
                   square = d1 * d1 - fall * rise;
      if (slow == 0 && square > 0.0) {
        const double d2 = std::sqrt(square);
        x = width - width * (rise + d2 - d1) / (rise - fall + 2.0 * d2);
      }
    }
    const SimTime t = after(left.hit.at, std::clamp(x, 0.0, width), right.hit.at);
    if (t == left.hit.at || t == right.hit.at) return;
    const Hit hit = measure(t);
    const Sample next{hit, rate_mps(hit, to)};
    (next.rate_mps >= 0.0 || next.clearance_m() > left.clearance_m() ? right : left) = next;
    slow = seconds_between(left.hit.at, right.hit.at) > 0.5 * width ? (slow + 1) % 3 : 0;
  }
}

// Proves that no instant between the best one and `until` is better.
void ClosestSearch::prove(SimTime until) {
  while (!below(0.0)) {
    const Hit from = best_;
    Hit ignored = best_;
    const auto lower =
        advance(a_, b_, from, until, from.apart.clearance_m - tolerance_m_, count_, Dating::Rough, ignored);
    if (!lower) return;
    best_ = *lower;
    descend(*lower, until);
    prove(lower->at);
  }
}

}  // namespace fleetproof
