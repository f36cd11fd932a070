#include "core/agents/hull.hpp"

#include <algorithm>
#include <cmath>

namespace fleetproof::agents {
namespace {

constexpr double kHullRounding_m = 1e-3;
constexpr double kHullSlack_m = 1.0;  // shapes are a little larger than what a body sweeps

}  // namespace

bool HullGeometry::conflict(std::uint32_t agv_a, const Path& a, std::uint32_t agv_b, const Path& b) {
  if (!parts_.key().options.shapes_decide) return share_a_station(map_, a, b);
  const Hull& hull = hull_of(agv_a, a);
  const Vec begin_b_m = map_.position_m(b.station);
  if (!hull.box.comes_within(extent_m(agv_b, b) + clearance_m(), {begin_b_m, begin_b_m})) return false;
  const Parts& of_a = hull.parts;
  Parts of_b;
  collect(agv_b, b, of_b);
  if (of_a.count == 0) {
    if (of_b.count == 0) return closer_than(of_a.body, of_b.body, clearance_m());
    return std::any_of(of_b.numbers, of_b.numbers + of_b.count,
                       [&](std::uint32_t n) { return parts_.conflicts_with_body(n, of_a.body); });
  }
  const Box around_b = box_around(of_b);
  return std::any_of(of_a.numbers, of_a.numbers + of_a.count, [&](std::uint32_t n) {
    return parts_.box(n).comes_within(clearance_m() + kHullRounding_m, around_b) && part_conflicts(n, of_b);
  });
}

std::uint32_t HullGeometry::clear_lanes(std::uint32_t agv_a, const Path& a, std::uint32_t agv_b, const Path& b) {
  if (!conflict(agv_a, a, agv_b, b)) return a.count;
  Path part = a;
  std::uint32_t clear = 0, met = a.count;
  while (clear + 1 < met) {
    part.count = (clear + met) / 2;
    (conflict(agv_a, part, agv_b, b) ? met : clear) = part.count;
  }
  return clear;
}

bool HullGeometry::lane_conflict(std::uint32_t agv_a, std::uint32_t lane, std::uint32_t agv_b, const Path& b) {
  if (is_far(parts_.of_lane(agv_a, lane), agv_b, b)) return false;
  Parts of_b;
  collect(agv_b, b, of_b);
  return part_conflicts(parts_.of_lane(agv_a, lane), of_b);
}

bool HullGeometry::turn_conflict(std::uint32_t agv_a, std::uint32_t station, std::uint32_t agv_b, const Path& b) {
  if (is_far(parts_.of_turn(agv_a, station), agv_b, b)) return false;
  Parts of_b;
  collect(agv_b, b, of_b);
  return part_conflicts(parts_.of_turn(agv_a, station), of_b);
}

double HullGeometry::meets_after_m(std::uint32_t agv_a, std::uint32_t station, std::uint32_t agv_b,
                                   const Path& b) const {
  const double apart_m = length(map_.position_m(station) - map_.position_m(b.station));
  return apart_m - reach_m(agv_a) - kHullSlack_m - extent_m(agv_b, b) - clearance_m();
}

double HullGeometry::distance_bound_m(Vec point_m, std::uint32_t agv, const Path& path) {
  Parts parts;
  collect(agv, path, parts);
  if (parts.count == 0) return length(point_m - parts.body.centre_m) - parts.body.reach_m();
  double least_m = INFINITY;
  for (std::uint32_t i = 0; i < parts.count; ++i)
    least_m = std::min(least_m, parts_.distance_bound_m(point_m, parts.numbers[i]));
  return least_m;
}

double HullGeometry::extent_m(std::uint32_t agv, const Path& path) const {
  return length_m(map_, path) + reach_m(agv) + kHullSlack_m;
}

bool HullGeometry::is_far(std::uint32_t number, std::uint32_t agv, const Path& path) const {
  return parts_.distance_bound_m(map_.position_m(path.station), number) > extent_m(agv, path) + clearance_m();
}

const HullGeometry::Hull& HullGeometry::hull_of(std::uint32_t agv, const Path& path) {
  if (last_.agv == agv && is_identical(last_.path, path)) return last_;
  last_.agv = agv;
  last_.path = path;
  last_.parts.count = 0;
  collect(agv, path, last_.parts);
  last_.box = box_around(last_.parts);
  return last_;
}

void HullGeometry::collect(std::uint32_t agv, const Path& path, Parts& parts) const {
  Vec heading = path.heading;
  for (const std::uint32_t lane : path.lanes()) {
    const Vec start = map_.start_heading(lane);
    if (parts_.key().options.turns_count && !same_heading(heading, start))
      parts.numbers[parts.count++] = parts_.of_turn(agv, map_.lane(lane).from, heading, start);
    parts.numbers[parts.count++] = parts_.of_lane(agv, lane);
    heading = map_.end_heading(lane);
  }
  if (parts.count == 0) parts.body = body_at(map_.position_m(path.station), path.heading, parts_.body(agv));
}

Box HullGeometry::box_around(const Parts& parts) const {
  if (parts.count == 0) return Box::around(parts.body);
  Box box = parts_.box(parts.numbers[0]);
  for (std::uint32_t i = 1; i < parts.count; ++i) box.extend(parts_.box(parts.numbers[i]));
  return box;
}

bool HullGeometry::part_conflicts(std::uint32_t number, const Parts& others) {
  if (others.count == 0) return parts_.conflicts_with_body(number, others.body);
  return std::any_of(others.numbers, others.numbers + others.count,
                     [&](std::uint32_t n) { return parts_.conflict(number, n); });
}

}  // namespace fleetproof::agents
