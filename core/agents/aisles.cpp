#include "core/agents/aisles.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace fleetproof::agents {

Aisles::Aisles(const MapView& map, std::uint32_t fleet_count)
    : map_(map), against_(map.lane_count(), false), dead_end_(map.station_count(), false) {
  double map_m = 0.0;
  for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane)
    map_m += map.lane(lane).length_m / (map.two_way(lane) ? 2.0 : 1.0);
  find_dead_ends();
  for (const Way& there : find_aisles()) {
    const bool is_ring = map.lane(there.front()).from == map.lane(there.back()).to;
    const double others_inside = (fleet_count - 1.0) * length_m(there) / map_m;
    if (is_ring || !has_goals(there) || there.size() < kFewestSegments || others_inside < kOthersInside) continue;
    const Way back = opposite(there);
    const double there_m = way_round_m(there, INFINITY), back_m = way_round_m(back, there_m);
    if (std::isinf(there_m) && std::isinf(back_m)) continue;
    set_against(there_m < back_m ? there : back, true);
  }
}

// One direction of each.
std::vector<Aisles::Way> Aisles::find_aisles() const {
  std::vector<Way> aisles;
  std::vector<bool> seen(map_.lane_count(), false);
  for (std::uint32_t lane = 0; lane < map_.lane_count(); ++lane) {
    const bool branch = dead_end_[map_.lane(lane).from] || dead_end_[map_.lane(lane).to];
    if (seen[lane] || branch || !map_.two_way(lane)) continue;
    const Way aisle = along(opposite(along(lane_back(lane))).front());
    for (const Way& way : {aisle, opposite(aisle)}) {
      for (const std::uint32_t of_way : way) {
        for (const std::uint32_t same : lanes_beside(of_way)) seen[same] = true;
      }
    }
    aisles.push_back(aisle);
  }
  return aisles;
}

// Whether AGVs stop between its ends.
bool Aisles::has_goals(const Way& way) const {
  return std::any_of(way.begin() + 1, way.end(),
                     [&](std::uint32_t lane) { return map_.station(map_.lane(lane).from).purposes != FP_ROUTING; });
}

double Aisles::length_m(const Way& way) const {
  double sum_m = 0.0;
  for (const std::uint32_t lane : way) sum_m += map_.lane(lane).length_m;
  return sum_m;
}

// Takes away stations with one way only, one after the other. What is left has a way round, or lies between two parts
// that have one.
void Aisles::find_dead_ends() {
  std::vector<std::uint32_t> left(map_.station_count());
  for (std::uint32_t id = 0; id < map_.station_count(); ++id) left[id] = id;
  while (!left.empty()) {
    const std::uint32_t station = left.back();
    left.pop_back();
    if (dead_end_[station] || degree(station) > 1) continue;
    dead_end_[station] = true;
    for (const std::uint32_t lane : map_.lanes_from(station)) left.push_back(map_.lane(lane).to);
    for (const std::uint32_t lane : map_.lanes_to(station)) left.push_back(map_.lane(lane).from);
  }
}

// Segments at the station that lead to no dead end.
std::uint32_t Aisles::degree(std::uint32_t station) const {
  std::vector<std::uint32_t> segments;
  const auto count = [&](std::uint32_t lane, std::uint32_t other_end) {
    const std::uint32_t segment = map_.lane(lane).segment;
    if (!dead_end_[other_end] && std::ranges::find(segments, segment) == segments.end()) segments.push_back(segment);
  };
  for (const std::uint32_t lane : map_.lanes_from(station)) count(lane, map_.lane(lane).to);
  for (const std::uint32_t lane : map_.lanes_to(station)) count(lane, map_.lane(lane).from);
  return static_cast<std::uint32_t>(segments.size());
}

// Requires: the segment is two-way.
std::uint32_t Aisles::lane_back(std::uint32_t lane) const {
  for (const std::uint32_t back : map_.lanes_from(map_.lane(lane).to)) {
    if (map_.lane(back).segment == map_.lane(lane).segment) return back;
  }
  return FP_NONE;
}

// FP_NONE at the end of the aisle.
std::uint32_t Aisles::next_in_aisle(std::uint32_t lane) const {
  const std::uint32_t station = map_.lane(lane).to;
  if (degree(station) != 2) return FP_NONE;
  for (const std::uint32_t next : map_.lanes_from(station)) {
    if (map_.lane(next).segment != map_.lane(lane).segment && !dead_end_[map_.lane(next).to])
      return map_.two_way(next) ? next : FP_NONE;
  }
  return FP_NONE;
}

// The aisle from this lane on.
Aisles::Way Aisles::along(std::uint32_t first) const {
  Way way;
  for (std::uint32_t lane = first; lane != FP_NONE; lane = next_in_aisle(lane)) {
    if (!way.empty() && map_.lane(lane).segment == map_.lane(first).segment) break;  // a ring
    way.push_back(lane);
  }
  return way;
}

Aisles::Way Aisles::opposite(const Way& way) const {
  Way back;
  for (const std::uint32_t lane : way) back.push_back(lane_back(lane));
  std::ranges::reverse(back);
  return back;
}

// From the beginning of this direction to its end, if it is closed. Infinite if there is no way. Of a way that is
// longer than the limit, it only says that.
double Aisles::way_round_m(const Way& closed, double limit_m) {
  const std::uint32_t from = map_.lane(closed.front()).from, to = map_.lane(closed.back()).to;
  set_against(closed, true);
  so_far_m_.assign(map_.station_count(), INFINITY);
  so_far_m_[from] = 0.0;
  using Open = std::pair<double, std::uint32_t>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  open.push({0.0, from});
  while (!open.empty() && open.top().second != to && open.top().first <= limit_m) {
    const auto [here_m, here] = open.top();
    open.pop();
    if (here_m > so_far_m_[here]) continue;
    for (const std::uint32_t lane : map_.lanes_from(here)) {
      const double there_m = here_m + map_.lane(lane).length_m;
      if (against_[lane] || there_m >= so_far_m_[map_.lane(lane).to]) continue;
      so_far_m_[map_.lane(lane).to] = there_m;
      open.push({there_m, map_.lane(lane).to});
    }
  }
  set_against(closed, false);
  return so_far_m_[to];
}

void Aisles::set_against(const Way& way, bool against) {
  for (const std::uint32_t lane : way) {
    for (const std::uint32_t same : lanes_beside(lane)) against_[same] = against;
  }
}

// The lanes of the same segment and direction: this one, and a lane backward beside it.
std::vector<std::uint32_t> Aisles::lanes_beside(std::uint32_t lane) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t other : map_.lanes_from(map_.lane(lane).from)) {
    if (map_.lane(other).segment == map_.lane(lane).segment && map_.lane(other).to == map_.lane(lane).to)
      found.push_back(other);
  }
  return found;
}

std::span<const std::uint8_t> lanes_against_aisles(const fp_facts& facts) {
  return ask<std::uint8_t>(
      facts,
      [](const fp_facts* from, std::uint64_t, fp_answer* to) {
        const MapView map(*from);
        std::vector<std::uint8_t> against(map.lane_count(), 0);
        if (from->fleet_count > 1) {
          const Aisles aisles(map, from->fleet_count);
          for (std::uint32_t id = 0; id < map.lane_count(); ++id) against[id] = aisles.is_against(id) ? 1 : 0;
        }
        answer(*from, to, against);
      },
      0);
}

}  // namespace fleetproof::agents
