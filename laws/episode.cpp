#include "laws/episode.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fleetproof {
namespace {

std::int64_t nearest_um(double value_m) { return std::llround(value_m * 1e6); }

Violation filed(const Episode& episode) {
  const Vec2 middle_m = 0.5 * (episode.body_a.centre_m + episode.body_b.centre_m);
  Violation violation{
      .a = episode.a, .b = episode.b, .first = episode.first, .last = episode.last, .closest_at = episode.closest.at};
  if (!episode.contact)
    violation.min_clearance_um = static_cast<std::int64_t>(std::floor(episode.closest.clearance_m * 1e6));
  violation.relative_speed_um_s = nearest_um(episode.speed.speed_mps);
  violation.normal_speed_um_s = nearest_um(episode.speed.normal_mps);
  violation.x_um = nearest_um(middle_m.x());
  violation.y_um = nearest_um(middle_m.y());
  violation.contact = episode.contact;
  return violation;
}

}  // namespace

void Episode::absorb(const Episode& other) {
  const SimTime from = std::min(first, other.first), to = std::max(last, other.last);
  const bool as_close = contact == other.contact &&
                        (contact || std::abs(closest.clearance_m - other.closest.clearance_m) <= kSameClearance_m);
  const bool closer = contact == other.contact ? other.closest.clearance_m < closest.clearance_m : other.contact;
  const RelativeSpeed faster = other.speed.speed_mps > speed.speed_mps ? other.speed : speed;
  if (as_close ? other.closest.at < closest.at : closer) *this = other;
  if (as_close) speed = faster;
  first = from;
  last = to;
}

Episode episode_of(const Piece& one, const Piece& other, SimTime first, SimTime last, const ClosestApproach& closest) {
  const Piece& a = one.entity < other.entity ? one : other;
  const Piece& b = one.entity < other.entity ? other : one;
  const SimTime at = closest.at;
  return {a.entity,
          b.entity,
          first,
          last,
          closest,
          a.body_at(at),
          b.body_at(at),
          closest.clearance_m < kTouch_m,
          relative_speed(a, b, at)};
}

std::vector<Episode> joined(std::vector<Episode> episodes, Duration seam) {
  std::ranges::sort(episodes, {}, [](const Episode& s) { return std::tuple(s.a, s.b, s.first, s.last); });
  std::vector<Episode> result;
  for (const Episode& next : episodes) {
    const bool same_pair = !result.empty() && result.back().a == next.a && result.back().b == next.b;
    if (same_pair && next.first - result.back().last <= seam) {
      result.back().absorb(next);
    } else {
      result.push_back(next);
    }
  }
  return result;
}

std::vector<Violation> filed(const std::vector<Episode>& episodes) {
  std::vector<Violation> violations;
  for (const Episode& episode : episodes) violations.push_back(filed(episode));
  std::ranges::sort(violations, {}, [](const Violation& v) { return std::tuple(v.first, v.a, v.b); });
  return violations;
}

}  // namespace fleetproof
