#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

MapView::MapView(const fp_map& map) : map_(map), lanes_of_segment_(map.segment_count) {
  start_headings_.reserve(lane_count());
  end_headings_.reserve(lane_count());
  arriving_begin_.assign(station_count() + 1, 0);
  for (std::uint32_t id = 0; id < lane_count(); ++id) {
    const fp_lane& l = lane(id);
    const fp_pose& start = arc(l, 0).start;
    const fp_pose end = end_of(arc(l, l.arc_count - 1));
    start_headings_.push_back({start.heading_x, start.heading_y});
    end_headings_.push_back({end.heading_x, end.heading_y});
    ++lanes_of_segment_[l.segment];
    ++arriving_begin_[l.to + 1];
  }
  for (std::uint32_t s = 0; s < station_count(); ++s) arriving_begin_[s + 1] += arriving_begin_[s];
  arriving_.resize(lane_count());
  std::vector<std::uint32_t> next = arriving_begin_;
  for (std::uint32_t id = 0; id < lane_count(); ++id) arriving_[next[lane(id).to]++] = id;
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

}  // namespace fleetproof::agents
