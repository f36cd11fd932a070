#include "core/agents/path.hpp"

#include <algorithm>

namespace fleetproof::agents {

bool operator==(const Path& a, const Path& b) {
  return a.station == b.station && std::ranges::equal(a.lanes(), b.lanes());
}

bool is_identical(const Path& a, const Path& b) {
  return a == b && a.heading.x == b.heading.x && a.heading.y == b.heading.y;
}

bool is_driveable(const MapView& map, const Path& path) {
  std::uint32_t at = path.station;
  if (at >= map.station_count()) return false;
  for (const std::uint32_t lane : path.lanes()) {
    if (lane >= map.lane_count() || map.lane(lane).from != at) return false;
    at = map.lane(lane).to;
  }
  return true;
}

Path end_of(const MapView& map, const Path& path) {
  Path end;
  end.station = path.empty() ? path.station : map.lane(path.lanes().back()).to;
  end.heading = path.empty() ? path.heading : map.end_heading(path.lanes().back());
  return end;
}

double length_m(const MapView& map, const Path& path) {
  double sum_m = 0.0;
  for (const std::uint32_t lane : path.lanes()) sum_m += map.lane(lane).length_m;
  return sum_m;
}

bool append_segment(const MapView& map, Path& path, std::uint32_t segment) {
  for (const std::uint32_t lane : map.lanes_from(end_of(map, path).station)) {
    if (map.action_segment(lane) == segment) return path.append(lane);
  }
  return false;
}

bool share_a_station(const MapView& map, const Path& a, const Path& b) {
  const auto passes = [&](const Path& path, std::uint32_t station) {
    return path.station == station ||
           std::ranges::any_of(path.lanes(), [&](std::uint32_t lane) { return map.lane(lane).to == station; });
  };
  return passes(a, b.station) ||
         std::ranges::any_of(b.lanes(), [&](std::uint32_t lane) { return passes(a, map.lane(lane).to); });
}

void pass_first_lane(const MapView& map, Path& path) {
  const std::uint32_t passed = path.lane_ids[0];
  path.station = map.lane(passed).to;
  path.heading = map.end_heading(passed);
  std::copy(path.lane_ids.begin() + 1, path.lane_ids.begin() + path.count, path.lane_ids.begin());
  --path.count;
}

}  // namespace fleetproof::agents
