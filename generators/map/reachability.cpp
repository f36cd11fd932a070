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

Reachability::Reachability(const LogicalMap& map, std::span<const std::string> vehicle_types)
    : map_(&map), in_core_(map.station_count(), false) {
  if (!has_rules(map.layout())) {
    uses_.push_back(uses_without_rules(map));
  } else {
    for (const std::string& type : vehicle_types) states_.emplace_back(map, type);
    if (states_.empty()) states_.emplace_back(map, "");
    for (const DriveStates& states : states_) uses_.push_back(states.uses());
  }
  for (std::size_t i = 0; i < in_core_.size(); ++i) {
    const auto some = [&](bool StationUse::*use) {
      return std::ranges::any_of(uses_, [&](const auto& uses) { return uses[i].*use; });
    };
    in_core_[i] = some(&StationUse::passed);
    if (in_core_[i]) core_.emplace_back(i);
    if (some(&StationUse::started)) starts_.emplace_back(i);
  }
}

bool Reachability::permits(std::uint32_t lane, bool loaded, std::uint32_t type) const {
  return states_.empty() || states_[type].permits(lane, loaded);
}

bool Reachability::may_start_along(std::uint32_t lane, std::uint32_t type) const {
  return states_.empty() || states_[type].may_start_along(lane);
}

bool Reachability::reaches(StationId from, StationId to, bool loaded, std::uint32_t type) const {
  const StationUse &there = use_of(to, type), &here = use_of(from, type);
  if (states_.empty()) return (here.passed && there.passed) || reaches_without_rules(from, to);
  if (loaded && here.picks && there.drops && carries_all(type)) return true;
  if (!loaded && (here.started || here.drops) && (there.stopped || there.picks)) return true;
  return states_[type].reaches(from, to, loaded);
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
