#include "generators/map/reachability.hpp"

namespace fleetproof {
namespace {

StrongComponents parts_of(const LogicalMap& map) {
  std::vector<Arrow> arrows;
  arrows.reserve(map.lanes().size());
  for (const auto& lane : map.lanes()) arrows.push_back({lane.from.value, lane.to.value});
  return strong_components(map.station_count(), arrows);
}

}  // namespace

Reachability::Reachability(const LogicalMap& map) : map_(&map), parts_(parts_of(map)) {
  core_.reserve(parts_.largest_size);
  for (std::size_t i = 0; i < map.station_count(); ++i) {
    if (parts_.in_largest(i)) core_.emplace_back(i);
  }
}

bool Reachability::reaches(StationId from, StationId to) const {
  if (parts_.component[from.index()] == parts_.component[to.index()]) return true;
  std::vector<bool> seen(map_->station_count(), false);
  std::vector<StationId> open{from};
  seen[from.index()] = true;
  while (!open.empty()) {
    const auto station = open.back();
    open.pop_back();
    for (const auto lane : map_->lanes_from(station)) {
      const auto next = map_->lanes()[lane].to;
      if (next == to) return true;
      if (!seen[next.index()]) {
        seen[next.index()] = true;
        open.push_back(next);
      }
    }
  }
  return false;
}

}  // namespace fleetproof
