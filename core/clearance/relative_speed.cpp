#include "core/clearance/relative_speed.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/tolerances.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof {
namespace {

// A point of each of two bodies, both on the floor.
struct PointPair {
  Vec2 on_first, on_second;
};

using Corners = std::array<Vec2, 4>;

// In this order: front left, rear left, rear right, front right. A side begins at the corner with its number: left,
// rear, right, front.
Corners corners(const OrientedRectangle& body) {
  const Vec2 along = body.half_length_m * body.heading, aside = body.half_width_m * left_of(body.heading);
  return {body.centre_m + along + aside, body.centre_m - along + aside, body.centre_m - along - aside,
          body.centre_m + along - aside};
}

Vec2 nearest_point_of(const OrientedRectangle& body, const Vec2& point_m) {
  const Vec2 offset = point_m - body.centre_m;
  const double along = std::clamp(offset.dot(body.heading), -body.half_length_m, body.half_length_m);
  const double aside = std::clamp(cross(body.heading, offset), -body.half_width_m, body.half_width_m);
  return body.centre_m + along * body.heading + aside * left_of(body.heading);
}

// What a view leaves out is farther away than this, which is far beyond its rounding.
constexpr double kClearlyAway_m = 1e-6;

// A rectangle as seen from the frame of another one. It selects what is then worked out exactly.
class View {
 public:
  View(const OrientedRectangle& from, const OrientedRectangle& other)
      : half_length_m_(from.half_length_m + kClearlyAway_m), half_width_m_(from.half_width_m + kClearlyAway_m) {
    const double cosine = from.heading.dot(other.heading), sine = cross(from.heading, other.heading);
    const Vec2 offset = other.centre_m - from.centre_m;
    x_ = offset.dot(from.heading);
    y_ = cross(from.heading, offset);
    length_x_ = other.half_length_m * cosine;
    length_y_ = other.half_length_m * sine;
    width_x_ = -other.half_width_m * sine;
    width_y_ = other.half_width_m * cosine;
  }

  // Which corners of the other rectangle may lie in this one: a bit each.
  unsigned corners_inside() const {
    return inside(1.0, 1.0) | inside(-1.0, 1.0) << 1U | inside(-1.0, -1.0) << 2U | inside(1.0, -1.0) << 3U;
  }
  // For each side of the other rectangle: which sides of this one lie on lines that it may cross, a bit each.
  std::array<unsigned, 4> lines_crossed() const {
    const double long_x = std::abs(length_x_) + 2.0 * kClearlyAway_m,
                 long_y = std::abs(length_y_) + 2.0 * kClearlyAway_m,
                 short_x = std::abs(width_x_) + 2.0 * kClearlyAway_m,
                 short_y = std::abs(width_y_) + 2.0 * kClearlyAway_m;
    return {lines_crossed(x_ + width_x_, y_ + width_y_, long_x, long_y),
            lines_crossed(x_ - length_x_, y_ - length_y_, short_x, short_y),
            lines_crossed(x_ - width_x_, y_ - width_y_, long_x, long_y),
            lines_crossed(x_ + length_x_, y_ + length_y_, short_x, short_y)};
  }
  // No point that both rectangles share moves faster. `velocity`: of the centre of this one, in its frame, against what
  // the other one does there; `turning_rad_s`: against the other one, too.
  double most_mps(const Vec2& velocity_mps, double turning_rad_s) const {
    const double reach_x = std::abs(length_x_) + std::abs(width_x_), reach_y = std::abs(length_y_) + std::abs(width_y_);
    const double low_x = std::max(-half_length_m_, x_ - reach_x - kClearlyAway_m),
                 high_x = std::min(half_length_m_, x_ + reach_x + kClearlyAway_m),
                 low_y = std::max(-half_width_m_, y_ - reach_y - kClearlyAway_m),
                 high_y = std::min(half_width_m_, y_ + reach_y + kClearlyAway_m);
    const double along = std::max(std::abs(velocity_mps.x() - turning_rad_s * low_y),
                                  std::abs(velocity_mps.x() - turning_rad_s * high_y)),
                 aside = std::max(std::abs(velocity_mps.y() + turning_rad_s * low_x),
                                  std::abs(velocity_mps.y() + turning_rad_s * high_x));
    return std::sqrt(along * along + aside * aside);
  }

 private:
  static unsigned bit(bool is) { return is ? 1U : 0U; }
  // By a side with this middle, which reaches so far from there.
  unsigned lines_crossed(double x, double y, double reach_x, double reach_y) const {
    return bit(std::abs(y - half_width_m_) <= reach_y) | bit(std::abs(x + half_length_m_) <= reach_x) << 1U |
           bit(std::abs(y + half_width_m_) <= reach_y) << 2U | bit(std::abs(x - half_length_m_) <= reach_x) << 3U;
  }
  unsigned inside(double ahead, double left) const {
    return bit(std::abs(x_ + ahead * length_x_ + left * width_x_) <= half_length_m_ &&
               std::abs(y_ + ahead * length_y_ + left * width_y_) <= half_width_m_);
  }

  double half_length_m_, half_width_m_;             // of this rectangle, a little grown
  double x_, y_;                                    // the centre of the other one
  double length_x_, length_y_, width_x_, width_y_;  // its half length and half width
};

// The two rectangles of a pair, each as seen from the other one.
struct Views {
  View from_first, from_second;

  Views(const OrientedRectangle& first, const OrientedRectangle& second)
      : from_first(first, second), from_second(second, first) {}
};

// The points at which two rectangles are nearest. If a whole edge is nearest, both of its ends. If the rectangles
// overlap, the corners of what they share; both points of such a pair are the same. Never empty.
class NearestPoints {
 public:
  // Of two that are apart.
  NearestPoints(const OrientedRectangle& first, const OrientedRectangle& second) {
    for (const Vec2& corner : corners(first)) add({corner, nearest_point_of(second, corner)});
    for (const Vec2& corner : corners(second)) add({nearest_point_of(first, corner), corner});
    double least_m = std::numeric_limits<double>::infinity();
    for (const PointPair& pair : *this) least_m = std::min(least_m, gap_m(pair));
    const auto farther = [&](const PointPair& pair) { return gap_m(pair) > least_m + kEquallyNear_m; };
    count_ = static_cast<std::size_t>(std::remove_if(pairs_.data(), pairs_.data() + count_, farther) - pairs_.data());
  }
  // Of two that overlap.
  NearestPoints(const OrientedRectangle& first, const OrientedRectangle& second, const Views& views) {
    const Corners of_first = corners(first), of_second = corners(second);
    for (unsigned left = views.from_second.corners_inside(); left != 0; left &= left - 1) {
      const Vec2& corner = of_first[static_cast<std::size_t>(std::countr_zero(left))];
      add_shared({corner, nearest_point_of(second, corner)});
    }
    for (unsigned left = views.from_first.corners_inside(); left != 0; left &= left - 1) {
      const Vec2& corner = of_second[static_cast<std::size_t>(std::countr_zero(left))];
      add_shared({nearest_point_of(first, corner), corner});
    }
    const auto by_first = views.from_second.lines_crossed(), by_second = views.from_first.lines_crossed();
    for (std::size_t i = 0; i < 4; ++i) {
      for (unsigned left = by_first[i]; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        if ((by_second[j] >> i & 1U) != 0) add_crossing(of_first, i, of_second, j);
      }
    }
  }

  const PointPair* begin() const { return pairs_.data(); }
  const PointPair* end() const { return pairs_.data() + count_; }

 private:
  static double gap_m(const PointPair& pair) { return (pair.on_second - pair.on_first).norm(); }

  void add(const PointPair& pair) { pairs_[count_++] = pair; }
  void add_shared(const PointPair& pair) {
    if (gap_m(pair) <= kEquallyNear_m) add(pair);
  }
  // Where two sides cross. Parallel sides share corners, or nothing.
  void add_crossing(const Corners& first, std::size_t i, const Corners& second, std::size_t j) {
    const Vec2 side = first[(i + 1) % 4] - first[i], other = second[(j + 1) % 4] - second[j],
               between = second[j] - first[i];
    const double sine = cross(side, other);
    if (std::abs(sine) <= kAlongSide * side.norm() * other.norm()) return;
    const double here = cross(between, other) / sine, there = cross(between, side) / sine;
    if (here < 0.0 || here > 1.0 || there < 0.0 || there > 1.0) return;
    const Vec2 at = first[i] + here * side;
    add({at, at});
  }

  std::array<PointPair, 4 + 4 + 16> pairs_;
  std::size_t count_ = 0;
};

// How a body moves at an instant.
struct Twist {
  Vec2 reference_m, velocity_mps;
  double turning_rad_s = 0.0;

  Vec2 velocity_of(const Vec2& point_m) const {
    return velocity_mps + turning_rad_s * left_of(Vec2(point_m - reference_m));
  }
};

// A body at an instant.
struct Moment {
  OrientedRectangle body;
  Twist twist;
};

Moment moment_of(const Piece& piece, SimTime t) {
  Moment moment;
  Twist& twist = moment.twist;
  const auto stands = [&](const Pose& pose) {
    moment.body = placed(piece.footprint, pose);
    twist = {moment.body.centre_m - piece.footprint.centre_ahead_m * moment.body.heading, Vec2::Zero()};
  };
  if (piece.manner == Manner::Rest) {
    stands(piece.start);
    return moment;
  }
  const double sign = piece.moves_against_heading() ? -1.0 : 1.0;
  const double speed = piece.profile.speed(to_seconds(std::clamp(t, piece.begin, piece.end) - piece.begin));
  if (piece.manner == Manner::Turn) {
    stands(piece.pose_at(t));
    twist.turning_rad_s = sign * speed;
  } else {
    const double way_m = piece.way_at(t);
    stands(piece.curve->pose_at(way_m));
    twist.velocity_mps = sign * speed * moment.body.heading;
    twist.turning_rad_s = speed * piece.curve->bending_at(way_m).per_m;
  }
  return moment;
}

// Two bodies at an instant.
struct Meeting {
  Moment a, b;

  Meeting(const Piece& one, const Piece& other, SimTime t) : a(moment_of(one, t)), b(moment_of(other, t)) {}

  // How the first moves at a point, against the second at another one.
  Vec2 closing_mps(const PointPair& at) const {
    return a.twist.velocity_of(at.on_first) - b.twist.velocity_of(at.on_second);
  }
  NearestPoints nearest(bool overlap) const {
    return overlap ? NearestPoints(a.body, b.body, Views(a.body, b.body)) : NearestPoints(a.body, b.body);
  }
  double highest_mps(const NearestPoints& pairs) const {
    double square = 0.0;
    for (const PointPair& pair : pairs) square = std::max(square, closing_mps(pair).squaredNorm());
    return std::sqrt(square);
  }
  // No point that both bodies share moves faster, one against the other.
  double most_mps(const Views& views) const {
    const double turning_rad_s = a.twist.turning_rad_s - b.twist.turning_rad_s;
    const auto within = [&](const OrientedRectangle& body, const View& view) {
      const Vec2 velocity = closing_mps({body.centre_m, body.centre_m});
      return view.most_mps({velocity.dot(body.heading), cross(body.heading, velocity)}, turning_rad_s);
    };
    return std::min(within(a.body, views.from_first), within(b.body, views.from_second));
  }
};

// How fast the fastest point of a body may be.
class Pace {
 public:
  explicit Pace(const Piece& piece) : piece_(piece) {
    const double reach_m = piece.footprint.reach_m() + kClearlyAway_m;
    if (piece.manner == Manner::Turn) times_speed_ = reach_m;
    if (piece.manner != Manner::Drive) return;
    double bending_per_m = 0.0;
    for (const CurvePart& part : piece.curve->parts()) bending_per_m = std::max(bending_per_m, part.most().per_m);
    times_speed_ = 1.0 + bending_per_m * reach_m;
  }

  double most_mps(SimTime t) const {
    if (times_speed_ == 0.0) return 0.0;
    return times_speed_ * piece_.profile.speed(to_seconds(std::clamp(t, piece_.begin, piece_.end) - piece_.begin));
  }

 private:
  const Piece& piece_;
  double times_speed_ = 0.0;  // metres for a turn, whose speed is an angle's; 0: at rest
};

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

// A bound on a speed is worked out in another way than the speed. The difference by rounding is far below this.
constexpr double kRounding_mps = 1e-9;

// Bodies in contact move on for seconds, so that there are hundreds of instants to look at. A bound on the speed, from
// the boxes of what the bodies share, says which of them cannot be the fastest.
class FastestInstant {
 public:
  FastestInstant(const Piece& a, const Piece& b, double below_m, EvaluationCount& count, double matters_from_mps)
      : a_(a), b_(b), pace_a_(a), pace_b_(b), below_m_(below_m), count_(count), matters_from_mps_(matters_from_mps) {}

  RelativeSpeed within(Interval all) {
    if (a_.manner == Manner::Rest && b_.manner == Manner::Rest) return {};
    samples_.reserve(256);
    add(all.begin, all);
    for (SimTime t = all.begin; t < all.end;) {
      const SimTime next = change_after(t, all.end);
      add_samples({t, next});
      t = next;
    }
    const auto matters = [&](const Sample& sample) { return sample.most_mps >= matters_from_mps_; };
    if (std::ranges::none_of(samples_, matters)) return {};
    choose();
    if (fastest_mps_ >= matters_from_mps_ || most_mps(around_) >= matters_from_mps_) narrow();
    return fastest_mps_ > 0.0 ? relative_speed(a_, b_, fastest_at_) : RelativeSpeed{};
  }

 private:
  struct Sample {
    SimTime t;
    Interval around;  // its neighbours
    double most_mps;  // no pair of nearest points is faster, whatever the places of the bodies
  };

  SimTime change_after(SimTime t, SimTime end) const {
    const SimTime of_a = motion_from(a_, a_.body_at(t), t, end, TimeSense::Forward).change,
                  of_b = motion_from(b_, b_.body_at(t), t, end, TimeSense::Forward).change;
    return std::max(t + Duration{1}, std::min({of_a, of_b, end}));
  }

  // Without rotation, the relative speed between two changes is largest at one of them. An arc ends in a step of the
  // turning rate: both sides of a change count.
  void add_samples(Interval phase) {
    constexpr int kSamples = 64;
    const bool steady = a_.keeps_heading() && b_.keeps_heading();
    const Duration step = std::max((phase.end - phase.begin) / (steady ? 1 : kSamples), Duration{1});
    const auto add_near = [&](SimTime t) { add(t, {std::max(phase.begin, t - step), std::min(phase.end, t + step)}); };
    for (SimTime t = phase.begin + Duration{1}; t < phase.end; t += step) add_near(t);
    add_near(phase.end - Duration{1});
    add_near(phase.end);
  }

  void add(SimTime t, Interval around) { samples_.push_back({t, around, most_mps(t)}); }
  double most_mps(SimTime t) const { return pace_a_.most_mps(t) + pace_b_.most_mps(t) + kRounding_mps; }
  // At any instant between the neighbours of a sample: in between, the paces change evenly. Those of the first sample
  // are the ends of the whole interval.
  double most_mps(Interval around) const {
    if (around.begin == samples_.front().t && around.end == samples_.back().t)
      return std::ranges::max(samples_, {}, &Sample::most_mps).most_mps;
    return std::max(most_mps(around.begin), most_mps(around.end));
  }

  // The fastest sample; of equals, the earliest. A few samples all over the time come first: their speeds rule out most
  // others. Samples that cannot matter are looked at if no other one does.
  void choose() {
    constexpr std::size_t kFew = 16;
    const Sample* fastest = nullptr;
    bool those_that_matter = true;
    const auto consider = [&](const Sample& sample) {
      if (sample.most_mps < fastest_mps_ || (sample.most_mps >= matters_from_mps_) != those_that_matter) return;
      const double here_mps = speed_at(sample.t, fastest_mps_);
      if (here_mps == 0.0) return;
      if (here_mps < fastest_mps_ || (here_mps == fastest_mps_ && fastest != nullptr && &sample >= fastest)) return;
      fastest_mps_ = here_mps;
      fastest = &sample;
    };
    const auto consider_all = [&] {
      for (std::size_t i = 0; i < samples_.size(); i += kFew) consider(samples_[i]);
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        if (i % kFew != 0) consider(samples_[i]);
      }
    };
    consider_all();
    those_that_matter = false;
    if (fastest_mps_ < matters_from_mps_) consider_all();
    if (fastest == nullptr) return;
    fastest_at_ = fastest->t;
    around_ = fastest->around;
  }

  // Of the fastest pair of nearest points. 0 if the clearance is not below the limit, or if no pair can be faster than
  // `than_mps`.
  double speed_at(SimTime t, double than_mps = 0.0) {
    ++count_.distance;
    const Meeting meeting(a_, b_, t);
    const double clearance = clearance_m(meeting.a.body, meeting.b.body);
    if (clearance >= below_m_) return 0.0;
    if (clearance > 0.0) return meeting.highest_mps(NearestPoints(meeting.a.body, meeting.b.body));
    const Views views(meeting.a.body, meeting.b.body);
    if (than_mps > 0.0 && meeting.most_mps(views) + kRounding_mps < than_mps) return 0.0;
    return meeting.highest_mps(NearestPoints(meeting.a.body, meeting.b.body, views));
  }

  // To the nanosecond, between the neighbours of the fastest sample.
  void narrow() {
    if ((a_.keeps_heading() && b_.keeps_heading()) || fastest_mps_ == 0.0) return;
    Interval left = around_;
    while (left.end - left.begin > Duration{2}) {
      const Duration third = (left.end - left.begin) / 3;
      const SimTime low = left.begin + third, high = left.end - third;
      if (is_slower(low, high)) {
        left.begin = low;
      } else {
        left.end = high;
      }
    }
  }

  // Whether the first of two instants is the slower one; both are offered.
  bool is_slower(SimTime low, SimTime high) {
    const double low_mps = speed_at(low), high_mps = speed_at(high);
    offer(low, low_mps);
    offer(high, high_mps);
    return low_mps < high_mps;
  }

  void offer(SimTime t, double here_mps) {
    if (here_mps <= fastest_mps_) return;
    fastest_mps_ = here_mps;
    fastest_at_ = t;
  }

  const Piece& a_;
  const Piece& b_;
  Pace pace_a_, pace_b_;
  double below_m_;
  EvaluationCount& count_;
  double matters_from_mps_;
  std::vector<Sample> samples_;
  double fastest_mps_ = 0.0;
  SimTime fastest_at_ = kStart;
  Interval around_;  // the neighbours of the fastest sample
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
