#include "generators/map/drive_states.hpp"

#include <utility>

namespace fleetproof {

DriveStates::DriveStates(const LogicalMap& map, std::string vehicle_type)
    : map_(&map), vehicle_type_(std::move(vehicle_type)), parts_(strong_components(2 * map.lanes().size(), arrows())) {}

bool DriveStates::exists(std::uint32_t state) const {
  return map_->segment(lane_of(state).segment).permits(vehicle_type_, state % 2 == 1);
}

template <class Visit>
void DriveStates::for_each_next(std::uint32_t state, const Visit& visit) const {
  if (!exists(state)) return;
  const Lane& lane = lane_of(state);
  const bool loaded = state % 2 == 1;
  const Vec2 heading = lane.end_heading();
  for (const std::uint32_t next : map_->lanes_from(lane.to)) {
    if (rules(loaded).may_drive(map_->lanes()[next], heading)) visit(this->state(next, loaded));
  }
  const std::uint32_t other = this->state(state / 2, !loaded);
  if (rules(loaded).may_stay(lane.to, heading)) visit(other);
}

std::vector<Arrow> DriveStates::arrows() const {
  std::vector<Arrow> arrows;
  for (std::uint32_t state = 0; state < 2 * map_->lanes().size(); ++state)
    for_each_next(state, [&](std::uint32_t next) { arrows.push_back({state, next}); });
  return arrows;
}

std::vector<bool> DriveStates::stations_in_core() const {
  std::vector<bool> in_core(map_->station_count(), false);
  for (std::uint32_t lane = 0; lane < map_->lanes().size(); ++lane) {
    const Lane& arriving = map_->lanes()[lane];
    const bool both = parts_.in_largest(state(lane, false)) && parts_.in_largest(state(lane, true));
    if (both && rules(false).may_stay(arriving.to, arriving.end_heading())) in_core[arriving.to.index()] = true;
  }
  return in_core;
}

bool DriveStates::reaches(StationId from, StationId to) const {
  if (from == to) return true;
  std::vector<bool> seen(2 * map_->lanes().size(), false);
  std::vector<std::uint32_t> open;
  const auto visit = [&](std::uint32_t state) {
    if (seen[state] || !exists(state)) return;
    seen[state] = true;
    open.push_back(state);
  };
  for (const std::uint32_t lane : map_->lanes_from(from)) {
    for (const bool loaded : {false, true}) visit(state(lane, loaded));
  }
  while (!open.empty()) {
    const std::uint32_t state = open.back();
    open.pop_back();
    if (lane_of(state).to == to && rules(false).may_stay(to, lane_of(state).end_heading())) return true;
    for_each_next(state, visit);
  }
  return false;
}

}  // namespace fleetproof
