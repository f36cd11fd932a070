#include "core/clearance/relative_speed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/tolerances.hpp"
#include "core/clearance/shared_points.hpp"
#include "core/clearance/speed_bounds.hpp"

namespace fleetproof {
namespace {

using namespace shared_points;

// The relative speed of every pair of nearest points.
template <class Visit>
void for_nearest(const Piece& a, const Piece& b, SimTime t, const Visit& visit) {
  const Meeting meeting(a, b, t);
  const auto [clearance, normal] = separation(meeting.a.body, meeting.b.body);
  for (const PointPair& pair : meeting.nearest(clearance <= 0.0)) {
    const Vec2 closing_mps = meeting.closing_mps(pair);
    visit(RelativeSpeed{closing_mps.norm(), closing_mps.dot(normal)});
  }
}

// Bodies in contact move on for seconds, so that there are hundreds of instants to look at. Bounds on what the bodies
// share, and on how that changes, say which of them cannot be the fastest. The time with the highest bound is looked at
// first, so that it leaves out most of the others.
class FastestInstant {
 public:
  FastestInstant(const Piece& a, const Piece& b, double below_m, EvaluationCount& count, double matters_from_mps)
      : a_(a), b_(b), pace_a_(a), pace_b_(b), below_m_(below_m), count_(count), matters_from_mps_(matters_from_mps) {}

  RelativeSpeed within(Interval all) {
    if (a_.manner == Manner::Rest && b_.manner == Manner::Rest) return {};
    if (pace_a_.most_mps(all) + pace_b_.most_mps(all) + kRounding_mps < matters_from_mps_) return {};
    if (all.begin == all.end) return at(all.begin);
    split(all);
    glimpses_.reserve(32);
    choose(matters_from_mps_);
    if (fastest_.mps < matters_from_mps_) {
      if (!may_matter_) return {};
      choose(0.0);
    }
    if (fastest_.mps >= matters_from_mps_ || may_matter_) narrow(fastest_.sample == 0 ? all : fastest_.around);
    return fastest_.mps > 0.0 ? relative_speed(a_, b_, fastest_.at) : RelativeSpeed{};
  }

 private:
  static constexpr std::size_t kFew = 8;
  static constexpr int kMostTries = 16;  // to do without the search to the nanosecond, which costs more
  // A time in which neither law of motion changes. Its samples are numbered from `first` on; `last` is just before its
  // end, and the next one at its end. The sample 0 is at the begin of all phases.
  struct Phase {
    Interval time;
    Tops of_a, of_b;
    double most_mps;  // no pair of nearest points is faster, whatever the places of the bodies
    Duration step;
    std::size_t first, last;

    SimTime time_of(std::size_t sample) const {
      if (sample == 0) return time.begin;
      if (sample >= last) return sample == last ? time.end - Duration{1} : time.end;
      return time.begin + Duration{1} + static_cast<std::int64_t>(sample - first) * step;
    }
    // Its neighbours.
    Interval around(SimTime t) const { return {std::max(time.begin, t - step), std::min(time.end, t + step)}; }
  };
  struct Fastest {
    double mps = 0.0;
    std::size_t sample = 0;
    SimTime at = kStart;
    Interval around;  // the neighbours of the sample
  };
  // A phase, or the time between two of its samples, of which `glimpses_` has what is seen at the ends.
  struct Window {
    double most_mps;  // no sample in it is faster
    std::size_t phase, first, last, at_first, at_last;
    bool is_phase;

    bool operator<(const Window& other) const { return most_mps < other.most_mps; }
  };

  // Of an interval without length.
  RelativeSpeed at(SimTime t) {
    ++count_.distance;
    return clearance_m(a_.body_at(t), b_.body_at(t)) < below_m_ ? relative_speed(a_, b_, t) : RelativeSpeed{};
  }

  // Without rotation, the relative speed between two changes is largest at one of them. An arc ends in a step of the
  // turning rate: both sides of a change count.
  void split(Interval all) {
    constexpr int kSamples = 64;
    const bool steady = a_.keeps_heading() && b_.keeps_heading();
    std::size_t first = 1;
    for (SimTime t = all.begin; t < all.end;) {
      const PhaseMotion of_a = motion_from(a_, a_.body_at(t), t, all.end, TimeSense::Forward),
                        of_b = motion_from(b_, b_.body_at(t), t, all.end, TimeSense::Forward);
      const Interval time{t, std::max(t + Duration{1}, std::min({of_a.change, of_b.change, all.end}))};
      const double most_mps = pace_a_.most_mps(time) + pace_b_.most_mps(time) + kRounding_mps;
      const Duration lasts = time.end - time.begin, step = std::max(lasts / (steady ? 1 : kSamples), Duration{1});
      const std::size_t last = first + static_cast<std::size_t>((lasts - Duration{2} + step) / step);
      windows_.push_back({most_mps, phases_.size(), first, last, 0, 0, true});
      phases_.push_back({time, Tops(of_a), Tops(of_b), most_mps, step, first, last});
      first = last + 2;
      t = time.end;
    }
    std::make_heap(windows_.begin(), windows_.end());
  }

  // The fastest sample; of equals, the earliest. What is left out between two samples is slower than another sample, or
  // than `from_mps`.
  void choose(double from_mps) {
    for (const Window& window : set_aside_) push(window);
    set_aside_.clear();
    while (!windows_.empty() && windows_.front().most_mps >= std::max(fastest_.mps, from_mps)) {
      std::pop_heap(windows_.begin(), windows_.end());
      const Window window = windows_.back();
      windows_.pop_back();
      if (window.is_phase) {
        open(window);
      } else {
        look_into(window, from_mps);
      }
    }
  }
  void push(const Window& window) {
    if (window.most_mps < fastest_.mps) return;
    windows_.push_back(window);
    std::push_heap(windows_.begin(), windows_.end());
  }

  void open(const Window& window) {
    const Phase& phase = phases_[window.phase];
    if (window.phase == 0) consider(phase, 0);
    const std::size_t at_first = consider(phase, phase.first), at_last = consider(phase, phase.last);
    // On curves of one part, nothing changes by more within a nanosecond.
    constexpr double kChanges_mps = 1e-6;
    if (has_joints(a_) || has_joints(b_) || !is_exact() || glimpses_[at_last].most_mps() + kChanges_mps >= fastest_.mps)
      consider(phase, phase.last + 1);
    push_between(window.phase, phase.first, at_first, phase.last, at_last);
  }
  void push_between(std::size_t phase, std::size_t first, std::size_t at_first, std::size_t last, std::size_t at_last) {
    if (last - first < 2) return;
    push({most_mps(phases_[phase], glimpses_[at_first], glimpses_[at_last], lasts_s(phases_[phase], first, last)),
          phase, first, last, at_first, at_last, false});
  }
  static bool has_joints(const Piece& piece) {
    return piece.manner == Manner::Drive && piece.curve->parts().size() > 1;
  }
  static double lasts_s(const Phase& phase, std::size_t first, std::size_t last) {
    return to_seconds(phase.time_of(last) - phase.time_of(first));
  }

  void look_into(const Window& window, double from_mps) {
    const auto& [most, number, first, last, at_first, at_last, is_phase] = window;
    const Phase& phase = phases_[number];
    if (is_exact() &&
        SharedTracks(glimpses_[at_first], glimpses_[at_last], phase.of_a, phase.of_b, lasts_s(phase, first, last))
            .all_slower(std::max(fastest_.mps, from_mps))) {
      if (from_mps > fastest_.mps) set_aside_.push_back(window);
      return;
    }
    if (last - first <= kFew) {
      may_matter_ = may_matter_ || most >= matters_from_mps_;
      look_at(phase, {phase.time_of(first), phase.time_of(last)});
      for (std::size_t i = first + 1; i < last; ++i) offer(phase, i, speed_at(phase.time_of(i)));
      return;
    }
    const std::size_t middle = (first + last) / 2, at_middle = consider(phase, middle);
    push_between(number, first, at_first, middle, at_middle);
    push_between(number, middle, at_middle, last, at_last);
  }

  // Whether bounds on shared points are bounds on the speed.
  bool is_exact() const { return below_m_ <= kTouch_m; }

  // Between two instants of a phase, no point that both bodies share is faster.
  double most_mps(const Phase& phase, const Glimpse& from, const Glimpse& to, double lasts_s) const {
    if (!is_exact()) return std::numeric_limits<double>::infinity();
    const Tops &of_a = phase.of_a, &of_b = phase.of_b;
    const double half_s = 0.5 * lasts_s, strays = 0.5 * half_s * half_s,
                 distance_m = std::max(from.distance_m, to.distance_m) + half_s * (of_a.mps + of_b.mps);
    const auto most = [&](const Share& one, const Share& other, const Straying& straying) {
      Box box = one.other;
      box.add(other.other);
      box = box.grown(strays * straying.other_mps2);
      return std::max(one.most_mps(box), other.most_mps(box)) + strays * straying.velocity_mps3;
    };
    return std::min(most(from.of_a, to.of_a, Straying(of_a, of_b, distance_m)),
                    most(from.of_b, to.of_b, Straying(of_b, of_a, distance_m))) +
           kClearlyAway_m * (of_a.rad_s + of_b.rad_s) + kRounding_mps;
  }

  std::size_t consider(const Phase& phase, std::size_t sample) {
    ++count_.distance;
    const Meeting meeting(a_, b_, phase.time_of(sample));
    const Views views(meeting.a.body, meeting.b.body);
    glimpses_.emplace_back(meeting, views);
    offer(phase, sample, speed_of(meeting, views, glimpses_.back()));
    return glimpses_.size() - 1;
  }
  void offer(const Phase& phase, std::size_t sample, double here_mps) {
    if (here_mps == 0.0 || here_mps < fastest_.mps || (here_mps == fastest_.mps && sample >= fastest_.sample)) return;
    const SimTime at = phase.time_of(sample);
    fastest_ = {here_mps, sample, at, phase.around(at)};
  }

  // Of the fastest pair of nearest points. 0 if the clearance is not below the limit, or if no pair can be as fast as
  // the fastest so far.
  double speed_of(const Meeting& meeting, const Views& views, const Glimpse& glimpse) const {
    const double clearance = clearance_m(meeting.a.body, meeting.b.body);
    if (clearance >= below_m_) return 0.0;
    if (clearance > 0.0) return meeting.highest_apart_mps();
    if (fastest_.mps > 0.0 && glimpse.most_mps() + kRounding_mps < fastest_.mps) return 0.0;
    return meeting.highest_shared_mps(views.candidates());
  }

  // To the nanosecond, between the neighbours of the fastest sample.
  void narrow(Interval left) {
    if ((a_.keeps_heading() && b_.keeps_heading()) || fastest_.mps == 0.0) return;
    constexpr int kRounds = 8;
    if (is_exact() && !may_be_faster(left)) return;
    for (int i = 0; left.end - left.begin > Duration{2}; ++i) {
      if (i % kRounds == 0) look_at(left);
      const Duration third = (left.end - left.begin) / 3;
      const SimTime low = left.begin + third, high = left.end - third;
      if (is_slower(low, high)) {
        left.begin = low;
      } else {
        left.end = high;
      }
    }
  }

  // Whether an instant of this time, other than the fastest so far, may be faster.
  bool may_be_faster(Interval within) {
    int left = kMostTries;
    for (const Phase& phase : phases_) {
      const Interval time{std::max(within.begin, phase.time.begin + Duration{1}),
                          std::min(within.end, phase.time.end - Duration{1})};
      if (time.begin >= time.end || phase.most_mps < fastest_.mps) continue;
      if (may_be_faster(phase, time, glimpse(time.begin), glimpse(time.end), left)) return true;
    }
    return false;
  }
  bool may_be_faster(const Phase& phase, Interval time, const Glimpse& from, const Glimpse& to, int& left) {
    constexpr Duration kNext{1}, kShortest = std::chrono::milliseconds(1);
    if (left-- <= 0 || (fastest_.at > time.begin + kNext && fastest_.at < time.end - kNext)) return true;
    const bool at_begin = fastest_.at <= time.begin && fastest_.at + kNext >= time.begin,
               at_end = fastest_.at >= time.end && fastest_.at - kNext <= time.end;
    const auto peak = at_begin ? SharedTracks::Peak::Begin
                      : at_end ? SharedTracks::Peak::End
                               : SharedTracks::Peak::None;
    const double lasts_s = to_seconds(time.end - time.begin);
    if (SharedTracks(from, to, phase.of_a, phase.of_b, lasts_s).all_slower(fastest_.mps, peak)) return false;
    if (time.end - time.begin < kShortest) return true;
    const SimTime middle = time.begin + (time.end - time.begin) / 2;
    const Glimpse at_middle = glimpse(middle);
    return may_be_faster(phase, {time.begin, middle}, from, at_middle, left) ||
           may_be_faster(phase, {middle, time.end}, at_middle, to, left);
  }
  Glimpse glimpse(SimTime t) {
    ++count_.distance;
    const Meeting meeting(a_, b_, t);
    return Glimpse(meeting, Views(meeting.a.body, meeting.b.body));
  }

  // Whether the first of two instants is the slower one; both are offered.
  bool is_slower(SimTime low, SimTime high) {
    const double low_mps = speed_at(low), high_mps = speed_at(high);
    offer(low, low_mps);
    offer(high, high_mps);
    return low_mps < high_mps;
  }

  double speed_at(SimTime t) {
    ++count_.distance;
    const Meeting meeting(a_, b_, t);
    const bool overlaps = candidates_ && candidates_->overlap;
    const double clearance = overlaps ? 0.0 : clearance_m(meeting.a.body, meeting.b.body);
    if (clearance <= 0.0 && candidates_) {
      const double speed_mps = meeting.highest_shared_mps(candidates_->fast);
      if (speed_mps > candidates_->others_mps) return speed_mps;
    }
    if (clearance >= below_m_) return 0.0;
    return clearance > 0.0 ? meeting.highest_apart_mps()
                           : meeting.highest_shared_mps(Views(meeting.a.body, meeting.b.body).candidates());
  }

  // Sets the candidates between two instants.
  void look_at(Interval window) {
    candidates_.reset();
    for (const Phase& phase : phases_) {
      if (window.begin >= phase.time.begin && window.end <= phase.time.end) return look_at(phase, window);
    }
  }
  void look_at(const Phase& phase, Interval window) {
    const SimTime middle = window.begin + (window.end - window.begin) / 2;
    candidates_.emplace(Meeting(a_, b_, middle), phase.of_a, phase.of_b, to_seconds(window.end - middle), fastest_.mps);
  }

  void offer(SimTime t, double here_mps) {
    if (here_mps <= fastest_.mps) return;
    fastest_.mps = here_mps;
    fastest_.at = t;
  }

  const Piece& a_;
  const Piece& b_;
  Pace pace_a_, pace_b_;
  double below_m_;
  EvaluationCount& count_;
  double matters_from_mps_;
  std::vector<Phase> phases_;
  std::vector<Window> windows_;  // a heap
  std::vector<Window> set_aside_;
  std::vector<Glimpse> glimpses_;
  Fastest fastest_;
  std::optional<FastCandidates> candidates_;
  bool may_matter_ = false;  // some instant may be faster than all samples, and as fast as matters
};

}  // namespace

RelativeSpeed relative_speed(const Piece& a, const Piece& b, SimTime t) {
  RelativeSpeed fastest;
  if (a.manner == Manner::Rest && b.manner == Manner::Rest) return fastest;
  for_nearest(a, b, t, [&](const RelativeSpeed& one) {
    if (one.speed_mps > fastest.speed_mps) fastest = one;
  });
  return fastest;
}

double clearance_rate_mps(const Piece& a, const Piece& b, SimTime t, TimeSense sense) {
  double rate = std::numeric_limits<double>::infinity();
  const double sign = sense == TimeSense::Forward ? -1.0 : 1.0;
  for_nearest(a, b, t, [&](const RelativeSpeed& one) { rate = std::min(rate, sign * one.normal_mps); });
  return rate;
}

RelativeSpeed fastest_below(const Piece& a, const Piece& b, Interval within, double below_m, EvaluationCount& count,
                            double matters_from_mps) {
  return FastestInstant(a, b, below_m, count, matters_from_mps).within(within);
}

}  // namespace fleetproof
