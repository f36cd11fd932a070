#include "generators/map/reachability.hpp"

#include <algorithm>

#include "generators/map/strong_components.hpp"

namespace fleetproof {
namespace {

std::vector<StationUse> uses_without_rules(const LogicalMap& map) {
  std::vector<Arrow> arrows;
  arrows.reserve(map.lanes().size());
  for (const auto& lane : map.lanes()) arrows.push_back({lane.from.value, lane.to.value});
  const StrongComponents parts = strong_components(map.station_count(), arrows);
  std::vector<StationUse> uses(map.station_count());
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (parts.in_largest(i)) uses[i] = kEveryUse;
  }
  return uses;
}

}  // namespace

Reachability::Reachability(const LogicalMap& map, std::span<const std::string> vehicle_types) : map_(&map) {
  if (!has_rules(map.layout())) {
    uses_ = uses_without_rules(map);
  } else {
    for (const std::string& type : vehicle_types) states_.emplace_back(map, type);
    if (states_.empty()) states_.emplace_back(map, "");
    uses_.assign(map.station_count(), kEveryUse);
    for (std::size_t i = 0; i < uses_.size(); ++i) {
      for (const DriveStates& states : states_) uses_[i] = uses_[i] & states.use_of(StationId{i});
    }
  }
  for (std::size_t i = 0; i < uses_.size(); ++i) {
    if (uses_[i].passed) core_.emplace_back(i);
    if (uses_[i].stopped) stops_.emplace_back(i);
  }
}

bool Reachability::may_start_along(std::uint32_t lane) const {
  return std::ranges::all_of(states_, [&](const DriveStates& states) { return states.may_start_along(lane); });
}

bool Reachability::reaches(StationId from, StationId to, bool loaded) const {
  const StationUse &there = use_of(to), &here = use_of(from);
  if (states_.empty()) return (here.passed && there.passed) || reaches_without_rules(from, to);
  if (loaded ? here.picks && there.drops : (here.stopped || here.drops) && (there.stopped || there.picks)) return true;
  return std::ranges::all_of(states_, [&](const DriveStates& states) { return states.reaches(from, to, loaded); });
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
