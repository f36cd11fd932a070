#include "core/agents/map_view.hpp"

#include <algorithm>
#include <cstddef>

namespace fleetproof::agents {

namespace {

bool tells_minor_2(const fp_map& map) {
  return map.lane_stride >= offsetof(fp_lane, permissions) + sizeof(fp_lane::permissions) &&
         map.station_stride >= offsetof(fp_station, heading_y) + sizeof(fp_station::heading_y);
}

std::vector<ShortName> short_names(const MapView& map) {
  std::vector<ShortName> names(map.station_count());
  for (std::uint32_t id = 0; id < map.station_count(); ++id) {
    ShortName& name = names[id];
    const std::string_view whole = station_name(map, id);
    name.size = whole.size() <= name.text.size() ? static_cast<std::uint8_t>(whole.size()) : ShortName::kIsLong;
    if (name.size != ShortName::kIsLong) std::copy(whole.begin(), whole.end(), name.text.begin());
  }
  return names;
}

}  // namespace

MapView::MapView(const fp_map& map) : map_(map), rules_known_(tells_minor_2(map)), own_(work_out()) { read(own_); }

MapView::MapView(const fp_facts& facts) : map_(*facts.map), facts_(&facts), rules_known_(tells_minor_2(*facts.map)) {
  read(ask<std::byte>(
      facts, [](const fp_facts* from, std::uint64_t, fp_answer* to) { answer(*from, to, MapView(*from->map).own_); },
      0));
}

std::vector<std::byte> MapView::work_out() const {
  std::vector<Vec> start_headings, end_headings;
  std::vector<std::uint8_t> two_way(map_.segment_count, 0);
  std::vector<std::uint32_t> first_from(map_.segment_count, FP_NONE), arriving_begin(station_count() + 1, 0);
  start_headings.reserve(lane_count()), end_headings.reserve(lane_count());
  for (std::uint32_t id = 0; id < lane_count(); ++id) {
    const fp_lane& l = lane(id);
    const fp_pose& start = arc(l, 0).start;
    const fp_pose end = end_of(arc(l, l.arc_count - 1));
    const double nose = is_backward(id) ? -1.0 : 1.0;
    start_headings.push_back({nose * start.heading_x, nose * start.heading_y});
    end_headings.push_back({nose * end.heading_x, nose * end.heading_y});
    if (first_from[l.segment] == FP_NONE) first_from[l.segment] = l.from;
    if (first_from[l.segment] != l.from) two_way[l.segment] = 1;
    ++arriving_begin[l.to + 1];
  }
  for (std::uint32_t s = 0; s < station_count(); ++s) arriving_begin[s + 1] += arriving_begin[s];
  std::vector<std::uint32_t> arriving(lane_count()), next = arriving_begin;
  for (std::uint32_t id = 0; id < lane_count(); ++id) arriving[next[lane(id).to]++] = id;
  TableWriter tables;
  tables.add(start_headings, end_headings, two_way, arriving, arriving_begin);
  return tables.bytes();
}

void MapView::read(std::span<const std::byte> tables) {
  TableReader reader(tables);
  start_headings_ = reader.next<Vec>();
  end_headings_ = reader.next<Vec>();
  two_way_ = reader.next<std::uint8_t>();
  arriving_ = reader.next<std::uint32_t>();
  arriving_begin_ = reader.next<std::uint32_t>();
}

void MapView::find_short_names() const {
  if (facts_ == nullptr) {
    own_short_names_ = short_names(*this);
    short_names_ = own_short_names_;
    return;
  }
  short_names_ = ask<ShortName>(
      *facts_,
      [](const fp_facts* from, std::uint64_t, fp_answer* to) { answer(*from, to, short_names(MapView(*from))); }, 0);
}

std::string_view station_name(const MapView& map, std::uint32_t station_id) {
  const char* const name = map.station(station_id).name;
  return name == nullptr ? std::string_view() : name;
}

bool MapView::has_chargers() const {
  for (std::uint32_t id = 0; id < station_count(); ++id) {
    if ((station(id).purposes & FP_CHARGING) != 0) return true;
  }
  return false;
}

std::span<const std::uint32_t> MapView::lanes_to(std::uint32_t station_id) const {
  return arriving_.subspan(arriving_begin_[station_id], arriving_begin_[station_id + 1] - arriving_begin_[station_id]);
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
