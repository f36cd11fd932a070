#include "generators/map/drive_states.hpp"

#include <utility>

namespace fleetproof {

DriveStates::DriveStates(const LogicalMap& map, std::string vehicle_type)
    : map_(&map), vehicle_type_(std::move(vehicle_type)), parts_{parts(false), parts(true)} {}

bool DriveStates::permits(std::uint32_t lane, bool loaded) const {
  return map_->segment(map_->lanes()[lane].segment).permits(vehicle_type_, loaded);
}

bool DriveStates::is_core(std::uint32_t lane, bool loaded) const {
  return permits(lane, loaded) && parts_[loaded ? 1 : 0].in_largest(lane);
}

template <class Visit>
void DriveStates::for_each_next(std::uint32_t lane, bool loaded, const Visit& visit) const {
  const Lane& driven = map_->lanes()[lane];
  const Vec2 heading = driven.end_heading();
  for (const std::uint32_t next : map_->lanes_from(driven.to)) {
    if (rules(loaded).may_drive(map_->lanes()[next], heading)) visit(next);
  }
}

StrongComponents DriveStates::parts(bool loaded) const {
  std::vector<Arrow> arrows;
  for (std::uint32_t lane = 0; lane < map_->lanes().size(); ++lane) {
    if (permits(lane, loaded)) for_each_next(lane, loaded, [&](std::uint32_t next) { arrows.push_back({lane, next}); });
  }
  return strong_components(map_->lanes().size(), arrows);
}

bool DriveStates::goes_on_in_core(std::uint32_t lane, bool loaded) const {
  bool goes_on = false;
  for_each_next(lane, loaded, [&](std::uint32_t next) { goes_on = goes_on || is_core(next, loaded); });
  return goes_on;
}

// An AGV comes empty, picks and goes on with the load; or comes with a load, drops and goes on empty.
std::vector<bool> DriveStates::stations_in_core() const {
  std::vector<bool> picks(map_->station_count(), false), drops = picks;
  for (std::uint32_t lane = 0; lane < map_->lanes().size(); ++lane) {
    const Lane& arriving = map_->lanes()[lane];
    const auto station = arriving.to.index();
    if (!rules(false).may_stay(arriving.to, arriving.end_heading())) continue;
    if (is_core(lane, false) && goes_on_in_core(lane, true)) picks[station] = true;
    if (is_core(lane, true) && goes_on_in_core(lane, false)) drops[station] = true;
  }
  for (std::size_t i = 0; i < picks.size(); ++i) picks[i] = picks[i] && drops[i];
  return picks;
}

bool DriveStates::reaches(StationId from, StationId to) const {
  return from == to || (reaches(from, to, false) && reaches(from, to, true));
}

bool DriveStates::reaches(StationId from, StationId to, bool loaded) const {
  std::vector<bool> seen(map_->lanes().size(), false);
  std::vector<std::uint32_t> open;
  const auto visit = [&](std::uint32_t lane) {
    if (seen[lane]) return;
    seen[lane] = true;
    open.push_back(lane);
  };
  for (const std::uint32_t lane : map_->lanes_from(from)) {
    if (permits(lane, loaded)) visit(lane);
  }
  while (!open.empty()) {
    const std::uint32_t lane = open.back();
    open.pop_back();
    const Lane& driven = map_->lanes()[lane];
    if (driven.to == to && rules(loaded).may_stay(to, driven.end_heading())) return true;
    for_each_next(lane, loaded, visit);
  }
  return false;
}

}  // namespace fleetproof
