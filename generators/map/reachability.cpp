#include "generators/map/reachability.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

std::vector<bool> core_without_rules(const LogicalMap& map) {
  std::vector<Arrow> arrows;
  arrows.reserve(map.lanes().size());
  for (const auto& lane : map.lanes()) arrows.push_back({lane.from.value, lane.to.value});
  const StrongComponents parts = strong_components(map.station_count(), arrows);
  std::vector<bool> in_core(map.station_count());
  for (std::size_t i = 0; i < in_core.size(); ++i) in_core[i] = parts.in_largest(i);
  return in_core;
}

}  // namespace

Reachability::Reachability(const LogicalMap& map, std::span<const std::string> vehicle_types) : map_(&map) {
  if (!has_rules(map.layout())) {
    in_core_ = core_without_rules(map);
  } else {
    for (const std::string& type : vehicle_types) states_.emplace_back(map, type);
    if (states_.empty()) states_.emplace_back(map, "");
    in_core_.assign(map.station_count(), true);
    for (const DriveStates& states : states_) {
      const auto of_type = states.stations_in_core();
      for (std::size_t i = 0; i < in_core_.size(); ++i) in_core_[i] = in_core_[i] && of_type[i];
    }
  }
  for (std::size_t i = 0; i < in_core_.size(); ++i) {
    if (in_core_[i]) core_.emplace_back(i);
  }
}

bool Reachability::may_start_along(std::uint32_t lane) const {
  return std::ranges::all_of(states_, [&](const DriveStates& states) { return states.in_core(lane); });
}

bool Reachability::reaches(StationId from, StationId to) const {
  if (in_core(from) && in_core(to)) return true;
  if (states_.empty()) return reaches_without_rules(from, to);
  return std::ranges::all_of(states_, [&](const DriveStates& states) { return states.reaches(from, to); });
}

bool Reachability::reaches_without_rules(StationId from, StationId to) const {
  if (from == to) return true;
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
