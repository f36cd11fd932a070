#include "tests/oracle/brute_force.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace fleetproof::oracle {
namespace {

constexpr Nanoseconds kTick = 10'000;

// Nearest point of a segment to a point.
Point nearest_on(Point p, Point from, Point to) {
  const Point side = to - from;
  const double share = std::clamp(dot(p - from, side) / dot(side, side), 0.0, 1.0);
  return from + share * side;
}

bool separated_by_a_side_of(const Corners& a, const Corners& b) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Point from = a[i], side = a[(i + 1) % 4] - from;
    bool outside = true;
    for (const Point& p : b) outside = outside && cross(side, p - from) < 0.0;
    if (outside) return true;
  }
  return false;
}

struct Apart {
  double distance_m = 0.0;
  Point way;  // from a to b along the nearest points, of that length
};

Apart apart(const Corners& a, const Corners& b) {
  if (!separated_by_a_side_of(a, b) && !separated_by_a_side_of(b, a)) return {};
  Apart best{std::numeric_limits<double>::infinity(), {}};
  const auto offer = [&](Point way) {
    const double square = dot(way, way);
    if (square < best.distance_m) best = {square, way};
  };
  for (std::size_t i = 0; i < 4; ++i) {
    for (const Point& p : b) offer(p - nearest_on(p, a[i], a[(i + 1) % 4]));
    for (const Point& p : a) offer(nearest_on(p, b[i], b[(i + 1) % 4]) - p);
  }
  best.distance_m = std::sqrt(best.distance_m);
  return best;
}

double gap_m(const Corners& a, const Corners& b, Point way) {
  double front = -1e300, back = 1e300;
  for (const Point& p : a) front = std::max(front, dot(way, p));
  for (const Point& p : b) back = std::min(back, dot(way, p));
  return (back - front) / length(way);
}

struct Look {
  Nanoseconds at = 0;
  Corners a, b;
  Apart apart;
};

class Clock {
 public:
  explicit Clock(const TrajectoryPair& pair)
      : pair_(pair),
        fastest_(pair.a.fastest_mps() + pair.b.fastest_mps()),
        strongest_(pair.a.strongest_mps2() + pair.b.strongest_mps2()) {}

  Look look(Nanoseconds t) const {
    Look look{t, pair_.a.corners(t), pair_.b.corners(t), {}};
    look.apart = apart(look.a, look.b);
    return look;
  }

  // Lower bound of the clearance between two looks.
  double bound_m(const Look& from, const Look& to) const {
    const double wait_s = static_cast<double>(to.at - from.at) * 1e-9;
    const double slowly = 0.5 * (from.apart.distance_m + to.apart.distance_m - fastest_ * wait_s);
    if (pair_.a.joint_between(from.at, to.at) || pair_.b.joint_between(from.at, to.at)) return slowly;
    double best = slowly;
    for (const Look* which : {&from, &to}) {
      if (which->apart.distance_m == 0.0) continue;
      const Point way = which->apart.way;
      best = std::max(
          best, std::min(gap_m(from.a, from.b, way), gap_m(to.a, to.b, way)) - strongest_ * wait_s * wait_s / 8.0);
    }
    return best;
  }

  Nanoseconds middle(Nanoseconds from, Nanoseconds to) const {
    return from + std::max((to - from) / kTick / 2, Nanoseconds{1}) * kTick;
  }

 private:
  const TrajectoryPair& pair_;
  double fastest_, strongest_;
};

// The first look below the level in (from, to].
std::optional<Look> first_look(const Clock& clock, const Look& from, const Look& to, double level_m) {
  const bool adjacent = to.at - from.at <= kTick;
  if (adjacent || clock.bound_m(from, to) >= level_m)
    return to.apart.distance_m < level_m ? std::optional(to) : std::nullopt;
  const Look middle = clock.look(clock.middle(from.at, to.at));
  if (const auto early = first_look(clock, from, middle, level_m)) return early;
  return first_look(clock, middle, to, level_m);
}

void lower(const Clock& clock, const Look& from, const Look& to, Lowest& lowest) {
  constexpr double kResolved_m = 1e-9;
  if (to.at - from.at <= kTick || lowest.clearance_m == 0.0 ||
      clock.bound_m(from, to) >= lowest.clearance_m - kResolved_m)
    return;
  const Look middle = clock.look(clock.middle(from.at, to.at));
  if (middle.apart.distance_m < lowest.clearance_m) lowest = {middle.apart.distance_m, middle.at};
  // The lower half first.
  if (from.apart.distance_m < to.apart.distance_m) {
    lower(clock, from, middle, lowest);
    lower(clock, middle, to, lowest);
  } else {
    lower(clock, middle, to, lowest);
    lower(clock, from, middle, lowest);
  }
}

// Downhill within an interval with one minimum.
Lowest by_thirds(const TrajectoryPair& pair, Nanoseconds from, Nanoseconds to) {
  while (to - from > 2) {
    const Nanoseconds third = (to - from) / 3, p = from + third, q = to - third;
    if (clearance_m(pair, p) < clearance_m(pair, q)) {
      to = q;
    } else {
      from = p;
    }
  }
  return {clearance_m(pair, from + (to - from) / 2), from + (to - from) / 2};
}

Lowest sampled(const TrajectoryPair& pair) {
  constexpr int kSamples = 200;
  Lowest best{clearance_m(pair, pair.end), pair.end};
  const auto offer = [&](const Lowest& other) {
    if (other.clearance_m < best.clearance_m) best = other;
  };
  const Nanoseconds step = std::max((pair.end - pair.begin) / kSamples, Nanoseconds{1});
  for (Nanoseconds t = pair.begin; t < pair.end; t += step) offer({clearance_m(pair, t), t});
  offer(by_thirds(pair, std::max(pair.begin, best.at - step), std::min(pair.end, best.at + step)));
  return best;
}

}  // namespace

double distance_m(const Corners& a, const Corners& b) { return apart(a, b).distance_m; }

double clearance_m(const TrajectoryPair& pair, Nanoseconds t) {
  return distance_m(pair.a.corners(t), pair.b.corners(t));
}

std::optional<Nanoseconds> first_below(const TrajectoryPair& pair, double level_m) {
  const Clock clock(pair);
  const Look begin = clock.look(pair.begin);
  if (begin.apart.distance_m < level_m) return pair.begin;
  const auto seen = first_look(clock, begin, clock.look(pair.end), level_m);
  if (!seen) return std::nullopt;
  Nanoseconds below = seen->at, above = std::max(pair.begin, below - kTick);
  while (below - above > 1) {
    const Nanoseconds middle = above + (below - above) / 2;
    (clearance_m(pair, middle) < level_m ? below : above) = middle;
  }
  return below;
}

Lowest lowest(const TrajectoryPair& pair) {
  const Clock clock(pair);
  Lowest best = sampled(pair);
  lower(clock, clock.look(pair.begin), clock.look(pair.end), best);
  const Lowest between = by_thirds(pair, std::max(pair.begin, best.at - kTick), std::min(pair.end, best.at + kTick));
  return between.clearance_m < best.clearance_m ? between : best;
}

Speed relative_speed(const TrajectoryPair& pair, Nanoseconds t) {
  constexpr double kAsNear_m = 1e-9;
  constexpr Nanoseconds kShortly = 20'000;
  struct Points {
    Point of_a, of_b;
  };
  const Corners a = pair.a.corners(t), b = pair.b.corners(t);
  std::vector<Points> nearest;
  double least_m = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Points& points) {
    nearest.push_back(points);
    least_m = std::min(least_m, length(points.of_b - points.of_a));
  };
  for (std::size_t i = 0; i < 4; ++i) {
    for (const Point& p : b) offer({nearest_on(p, a[i], a[(i + 1) % 4]), p});
    for (const Point& p : a) offer({p, nearest_on(p, b[i], b[(i + 1) % 4])});
  }
  // The velocity of a material point: its share along the sides of its body stays.
  const auto velocity = [&](const Trajectory& body, const Corners& now, Point p) {
    const Point front = now[0] - now[1], side = now[3] - now[0];
    const double x = dot(p - now[1], front) / dot(front, front), y = dot(p - now[1], side) / dot(side, side);
    const auto at = [&](Nanoseconds when) {
      const Corners c = body.corners(when);
      return c[1] + x * (c[0] - c[1]) + y * (c[3] - c[0]);
    };
    return 1e9 / (2.0 * static_cast<double>(kShortly)) * (at(t + kShortly) - at(t - kShortly));
  };
  Speed fastest;
  for (const auto& [p, q] : nearest) {
    if (length(q - p) > least_m + kAsNear_m) continue;
    const Point against = velocity(pair.a, a, p) - velocity(pair.b, b, q);
    if (length(against) > fastest.speed_mps) fastest = {length(against), dot(against, q - p) / length(q - p)};
  }
  return fastest;
}

double roughly_lowest_m(const TrajectoryPair& pair) { return sampled(pair).clearance_m; }

}  // namespace fleetproof::oracle
