#include "core/scenario/layout.hpp"

#include <algorithm>

#include "core/base/error.hpp"
#include "core/base/tolerances.hpp"
#include "core/geometry/arc.hpp"
#include "core/scenario/canonical_bytes.hpp"

namespace fleetproof {

bool Segment::permits(std::string_view vehicle_type, bool loaded) const {
  return permissions.empty() || std::ranges::any_of(permissions, [&](const Permission& permission) {
           return (permission.vehicle_type.empty() || vehicle_type.empty() ||
                   permission.vehicle_type == vehicle_type) &&
                  permission.load != (loaded ? LoadState::Empty : LoadState::Loaded);
         });
}

namespace {

// Calls `add` with the four control points of each cubic of a segment.
template <class Add>
void for_each_cubic(const Layout& layout, const Segment& segment, const Add& add) {
  const auto& c = segment.control_points_m;
  ensure(c.size() % 3 == 2, "a segment has 2, 5, 8, ... control points");
  Vec2 begin = layout.stations[segment.from.index()].position_m;
  for (std::size_t i = 0; i + 1 < c.size(); i += 3) {
    const Vec2 end = i + 2 < c.size() ? c[i + 2] : layout.stations[segment.to.index()].position_m;
    add(begin, c[i], c[i + 1], end);
    begin = end;
  }
}

std::vector<Arc> reversed(const std::vector<Arc>& arcs) {
  std::vector<Arc> back;
  for (auto arc = arcs.rbegin(); arc != arcs.rend(); ++arc) back.push_back(arc->reversed());
  return back;
}

}  // namespace

Curve segment_curve(const Layout& layout, const Segment& segment) {
  if (segment.control_points_m.empty())
    return Curve::straight(layout.stations[segment.from.index()].position_m,
                           layout.stations[segment.to.index()].position_m);
  std::vector<Curve> curves;
  for_each_cubic(layout, segment, [&](const Vec2& p0, const Vec2& p1, const Vec2& p2, const Vec2& p3) {
    curves.push_back(Curve::bezier(p0, p1, p2, p3));
  });
  return curves.size() == 1 ? curves[0] : Curve::joined(curves);
}

std::vector<Arc> segment_arcs(const Layout& layout, const Segment& segment) {
  std::vector<Arc> arcs;
  const auto add = [&](const Vec2& p0, const Vec2& p1, const Vec2& p2, const Vec2& p3) {
    const auto chain = biarc_chain({p0, p1, p2, p3}, {kBezierByArcs_m, kHeadingByArcs_rad});
    arcs.insert(arcs.end(), chain.begin(), chain.end());
  };
  if (segment.control_points_m.empty()) {
    const Vec2 from = layout.stations[segment.from.index()].position_m,
               to = layout.stations[segment.to.index()].position_m;
    add(from, from, to, to);
  } else {
    for_each_cubic(layout, segment, add);
  }
  return arcs;
}

MotionLimits Lane::limits(MotionLimits of_vehicle) const {
  if (speed_limit_mps > 0.0) of_vehicle.speed_mps = std::min(of_vehicle.speed_mps, speed_limit_mps);
  return of_vehicle;
}

LogicalMap::LogicalMap(const Layout& layout)
    : layout_(layout), digest_(layout_digest(layout)), lanes_from_(layout.stations.size()) {
  for (std::size_t i = 0; i < layout_.segments.size(); ++i) {
    const auto& segment = layout_.segments[i];
    const Curve forward = segment_curve(layout_, segment);
    const std::vector<Arc> arcs = segment_arcs(layout_, segment);
    add_lanes({SegmentId{i}, segment.from, segment.to, forward, arcs, segment.speed_limit_mps}, segment.travel);
    if (segment.bidirectional)
      add_lanes(
          {SegmentId{i}, segment.to, segment.from, forward.reversed(), reversed(arcs), segment.back_speed_limit_mps},
          segment.back_travel);
  }
  for (std::size_t i = 0; i < lanes_.size(); ++i)
    lanes_from_[lanes_[i].from.index()].push_back(static_cast<std::uint32_t>(i));
}

void LogicalMap::add_lanes(const Lane& forward, Travel travel) {
  if (travel != Travel::Backward) lanes_.push_back(forward);
  if (travel == Travel::Forward) return;
  lanes_.push_back(forward);
  lanes_.back().curve = forward.curve.tail_first();
}

const Lane* LogicalMap::lane(SegmentId segment, StationId from) const {
  for (const auto i : lanes_from_[from.index()]) {
    if (lanes_[i].segment == segment) return &lanes_[i];
  }
  return nullptr;
}

const Lane* LogicalMap::backward_lane(SegmentId segment, StationId from) const {
  for (const auto i : lanes_from_[from.index()]) {
    if (lanes_[i].segment == segment && lanes_[i].is_backward()) return &lanes_[i];
  }
  return nullptr;
}

}  // namespace fleetproof
