#include "core/agents/map_view.hpp"

#include <algorithm>
#include <cstddef>

namespace fleetproof::agents {

MapView::MapView(const fp_map& map)
    : map_(map),
      rules_known_(map.lane_stride >= offsetof(fp_lane, permissions) + sizeof(fp_lane::permissions) &&
                   map.station_stride >= offsetof(fp_station, heading_y) + sizeof(fp_station::heading_y)),
      two_way_(map.segment_count, false) {
  std::vector<std::uint32_t> first_from(map.segment_count, FP_NONE);
  start_headings_.reserve(lane_count());
  end_headings_.reserve(lane_count());
  arriving_begin_.assign(station_count() + 1, 0);
  for (std::uint32_t id = 0; id < lane_count(); ++id) {
    const fp_lane& l = lane(id);
    const fp_pose& start = arc(l, 0).start;
    const fp_pose end = end_of(arc(l, l.arc_count - 1));
    const double nose = is_backward(id) ? -1.0 : 1.0;
    start_headings_.push_back({nose * start.heading_x, nose * start.heading_y});
    end_headings_.push_back({nose * end.heading_x, nose * end.heading_y});
    if (first_from[l.segment] == FP_NONE) first_from[l.segment] = l.from;
    two_way_[l.segment] = two_way_[l.segment] || first_from[l.segment] != l.from;
    ++arriving_begin_[l.to + 1];
  }
  for (std::uint32_t s = 0; s < station_count(); ++s) arriving_begin_[s + 1] += arriving_begin_[s];
  arriving_.resize(lane_count());
  std::vector<std::uint32_t> next = arriving_begin_;
  for (std::uint32_t id = 0; id < lane_count(); ++id) arriving_[next[lane(id).to]++] = id;
}

bool MapView::has_chargers() const {
  for (std::uint32_t id = 0; id < station_count(); ++id) {
    if ((station(id).purposes & FP_CHARGING) != 0) return true;
  }
  return false;
}

std::span<const std::uint32_t> MapView::lanes_to(std::uint32_t station_id) const {
  return std::span(arriving_).subspan(arriving_begin_[station_id],
                                      arriving_begin_[station_id + 1] - arriving_begin_[station_id]);
}

fp_arc chord_of(const MapView& map, std::uint32_t lane_id) {
  const Vec from = map.position_m(map.lane(lane_id).from), way = map.position_m(map.lane(lane_id).to) - from;
  const Vec heading = way * (1.0 / length(way));
  fp_arc chord{};
  chord.start = {from.x, from.y, heading.x, heading.y};
  chord.length_m = length(way);
  return chord;
}

bool MapView::permits(std::uint32_t lane_id, std::uint32_t vehicle_type, bool loaded) const {
  const fp_lane& l = lane(lane_id);
  if (!rules_known_ || l.permission_count == 0) return true;
  return std::any_of(l.permissions, l.permissions + l.permission_count, [&](const fp_permission& permission) {
    return (permission.vehicle_type == FP_ANY_TYPE || permission.vehicle_type == vehicle_type) &&
           permission.load != (loaded ? FP_EMPTY_ONLY : FP_LOADED_ONLY);
  });
}

bool MapView::may_stay(std::uint32_t station_id, Vec heading) const {
  if (!asks_for_a_heading(station_id)) return true;
  return same_heading({station(station_id).heading_x, station(station_id).heading_y}, heading);
}

}  // namespace fleetproof::agents
