#include "core/agents/hull.hpp"

#include <algorithm>
#include <cmath>

#include "core/agents/fleet.hpp"

namespace fleetproof::agents {

HullGeometry::HullGeometry(const MapView& map, const fp_briefing& briefing, HullOptions options)
    : map_(map),
      options_(options),
      parts_per_kind_(map.lane_count() + map.station_count()),
      clearance_m_((options.margin_is_whole ? 1.0 : 0.5) * briefing.safety_distance_m) {
  for (std::uint32_t i = 0; i < briefing.fleet_count; ++i) {
    const fp_agv& agv = agv_of(briefing, options.sizes_differ ? i : briefing.self);
    // Always the size with a load: an AGV does not know whether another AGV is loaded.
    const double length_m = options.loads_count ? std::max(agv.length_m, agv.loaded_length_m) : agv.length_m,
                 width_m = options.loads_count ? std::max(agv.width_m, agv.loaded_width_m) : agv.width_m;
    const Body body{length_m, width_m, tells_minor_2(briefing) ? agv.centre_ahead_m : 0.0};
    const auto known = std::ranges::find(kinds_, body);
    kind_of_.push_back(static_cast<std::uint32_t>(known - kinds_.begin()));
    if (known == kinds_.end()) kinds_.push_back(body);
  }
  double reach_m = 0.0;
  for (const Body& kind : kinds_) reach_m = std::max(reach_m, kind.reach_m());
  clearance_m_ += std::max(kHullTolerance_m, 2.0 * kArcHeading_rad * reach_m);
  lanes_near_.emplace(map, 2.0 * reach_m + clearance_m_);
  parts_.reserve(kinds_.size() * parts_per_kind_);
  for (const Body& kind : kinds_) bound_parts(kind);
  known_pairs_.resize(parts_.size());
}

// No point of a lane is further from the middle between its ends than half the length of the lane.
void HullGeometry::bound_parts(const Body& kind) {
  for (std::uint32_t id = 0; id < map_.lane_count(); ++id) {
    const fp_lane& lane = map_.lane(id);
    const fp_pose& start = map_.arc(lane, 0).start;
    const fp_pose end = end_of(map_.arc(lane, lane.arc_count - 1));
    double length_m = 0.0;
    for (std::uint32_t i = 0; i < lane.arc_count; ++i) length_m += map_.arc(lane, i).length_m;
    Part& part = parts_.emplace_back();
    part.centre_m = Vec{start.x_m + end.x_m, start.y_m + end.y_m} * 0.5;
    part.reach_m = length_m / 2.0 + kind.reach_m();
  }
  for (std::uint32_t id = 0; id < map_.station_count(); ++id) {
    Part& part = parts_.emplace_back();
    part.centre_m = map_.position_m(id);
    part.reach_m = kind.reach_m();
  }
}

bool HullGeometry::conflict(std::uint32_t agv_a, const Path& a, std::uint32_t agv_b, const Path& b) {
  if (!options_.shapes_decide) return share_a_station(map_, a, b);
  Parts of_a, of_b;
  collect(agv_a, a, of_a);
  collect(agv_b, b, of_b);
  if (of_a.count == 0) {
    if (of_b.count == 0) return closer_than(of_a.body, of_b.body, clearance_m_);
    return std::any_of(of_b.numbers, of_b.numbers + of_b.count,
                       [&](std::uint32_t n) { return body_conflicts(of_a.body, n); });
  }
  return std::any_of(of_a.numbers, of_a.numbers + of_a.count, [&](std::uint32_t n) { return part_conflicts(n, of_b); });
}

bool HullGeometry::lane_conflict(std::uint32_t agv_a, std::uint32_t lane, std::uint32_t agv_b, const Path& b) {
  Parts of_b;
  collect(agv_b, b, of_b);
  return part_conflicts(lane_part(agv_a, lane), of_b);
}

bool HullGeometry::turn_conflict(std::uint32_t agv_a, std::uint32_t station, std::uint32_t agv_b, const Path& b) {
  Parts of_b;
  collect(agv_b, b, of_b);
  return part_conflicts(turn_part(agv_a, station), of_b);
}

bool HullGeometry::turning_blocks_lane(std::uint32_t station, std::uint32_t lane) {
  for (std::uint32_t standing = 0; standing < kinds_.size(); ++standing) {
    for (std::uint32_t driving = 0; driving < kinds_.size(); ++driving) {
      if (parts_conflict(standing * parts_per_kind_ + map_.lane_count() + station, driving * parts_per_kind_ + lane))
        return true;
    }
  }
  return false;
}

bool HullGeometry::standing_blocks_lane(std::uint32_t station, Vec heading, std::uint32_t lane) {
  for (const Body& standing : kinds_) {
    const Shape body = body_at(map_.position_m(station), heading, standing);
    for (std::uint32_t driving = 0; driving < kinds_.size(); ++driving) {
      if (body_conflicts(body, driving * parts_per_kind_ + lane)) return true;
    }
  }
  return false;
}

double HullGeometry::distance_bound_m(Vec point_m, std::uint32_t agv, const Path& path) {
  Parts parts;
  collect(agv, path, parts);
  if (parts.count == 0) return length(point_m - parts.body.centre_m) - parts.body.reach_m();
  double least_m = INFINITY;
  for (std::uint32_t i = 0; i < parts.count; ++i) {
    const Part& p = parts_[parts.numbers[i]];
    least_m = std::min(least_m, length(point_m - p.centre_m) - p.reach_m);
  }
  return least_m;
}

void HullGeometry::collect(std::uint32_t agv, const Path& path, Parts& parts) const {
  Vec heading = path.heading;
  for (const std::uint32_t lane : path.lanes()) {
    if (options_.turns_count && !same_heading(heading, map_.start_heading(lane)))
      parts.numbers[parts.count++] = turn_part(agv, map_.lane(lane).from);
    parts.numbers[parts.count++] = lane_part(agv, lane);
    heading = map_.end_heading(lane);
  }
  if (parts.count == 0) parts.body = body_at(map_.position_m(path.station), path.heading, kinds_[kind_of_[agv]]);
}

const HullGeometry::Part& HullGeometry::with_shapes(std::uint32_t number) {
  Part& p = parts_[number];
  if (p.count == 0) work_out(number, p);
  return p;
}

void HullGeometry::work_out(std::uint32_t number, Part& part) {
  const Body& kind = kinds_[number / parts_per_kind_];
  const std::uint32_t what = number % parts_per_kind_;
  part.first = static_cast<std::uint32_t>(shapes_.size());
  if (what >= map_.lane_count()) {
    const double reach_m = options_.corners_count ? kind.reach_m() : kind.length_m / 2.0;
    shapes_.push_back(disc_at(map_.position_m(what - map_.lane_count()), reach_m));
  } else if (!options_.bends_count) {
    append_sweep(chord_of(map_, what), map_.is_backward(what), kind, shapes_);
  } else {
    const fp_lane& lane = map_.lane(what);
    for (std::uint32_t i = 0; i < lane.arc_count; ++i)
      append_sweep(map_.arc(lane, i), map_.is_backward(what), kind, shapes_);
  }
  part.count = static_cast<std::uint32_t>(shapes_.size()) - part.first;
}

bool HullGeometry::parts_conflict(std::uint32_t a, std::uint32_t b) {
  if (a > b) std::swap(a, b);
  const double near_m = parts_[a].reach_m + parts_[b].reach_m + clearance_m_;
  const Vec apart_m = parts_[a].centre_m - parts_[b].centre_m;
  if (dot(apart_m, apart_m) >= near_m * near_m) return false;
  std::vector<Pair>& known = known_pairs_[a];
  const auto place = std::ranges::lower_bound(known, b, {}, &Pair::other);
  if (place != known.end() && place->other == b) return place->conflict;
  const bool found = shapes_conflict(with_shapes(a), with_shapes(b));
  known.insert(place, {b, found});
  return found;
}

bool HullGeometry::shapes_conflict(const Part& a, const Part& b) const {
  for (std::uint32_t i = 0; i < a.count; ++i) {
    for (std::uint32_t k = 0; k < b.count; ++k) {
      if (closer_than(shapes_[a.first + i], shapes_[b.first + k], clearance_m_)) return true;
    }
  }
  return false;
}

bool HullGeometry::part_conflicts(std::uint32_t number, const Parts& others) {
  if (others.count == 0) return body_conflicts(others.body, number);
  return std::any_of(others.numbers, others.numbers + others.count,
                     [&](std::uint32_t n) { return parts_conflict(number, n); });
}

bool HullGeometry::body_conflicts(const Shape& body, std::uint32_t number) {
  const double far_m = parts_[number].reach_m + body.reach_m() + clearance_m_;
  const Vec d = body.centre_m - parts_[number].centre_m;
  if (dot(d, d) >= far_m * far_m) return false;
  const Part& p = with_shapes(number);
  return std::any_of(shapes_.begin() + p.first, shapes_.begin() + p.first + p.count,
                     [&](const Shape& shape) { return closer_than(shape, body, clearance_m_); });
}

}  // namespace fleetproof::agents
