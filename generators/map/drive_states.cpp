#include "generators/map/drive_states.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace fleetproof {
namespace {

std::vector<bool> reached(std::span<const Arrow> arrows, std::size_t from, std::size_t nodes) {
  std::vector<bool> all(nodes, false);
  all[from] = true;
  reach_along(arrows, all);
  return all;
}

}  // namespace

DriveStates::DriveStates(const LogicalMap& map, std::string vehicle_type)
    : map_(&map), vehicle_type_(std::move(vehicle_type)), uses_(map.station_count()) {
  const std::size_t lanes = map.lanes().size();
  for (const bool loaded : {false, true}) {
    Traffic& traffic = traffic_[loaded];
    traffic.comes_from_there = traffic.leads_there = std::vector<bool>(lanes, false);
    for (const Lane& lane : map.lanes())
      traffic.permitted.push_back(map.segment(lane.segment).permits(vehicle_type_, loaded));
    for (std::uint32_t lane = 0; lane < lanes; ++lane)
      for_each_next(lane, loaded, [&](std::uint32_t next) { traffic.onward.push_back({lane, next}); });
  }
  const auto for_ever = states_for_ever();
  find_ways(false, for_ever);
  find_ways(true, for_ever);
  find_uses(for_ever);
}

bool DriveStates::stops_after(std::uint32_t lane) const {
  return rules(false).may_stay(map_->lanes()[lane].to, map_->lanes()[lane].end_heading());
}

template <class Visit>
void DriveStates::for_each_next(std::uint32_t lane, bool loaded, const Visit& visit) const {
  const Lane& driven = map_->lanes()[lane];
  const Vec2 heading = driven.end_heading();
  for (const std::uint32_t next : map_->lanes_from(driven.to)) {
    if (rules(loaded).may_drive(map_->lanes()[next], heading)) visit(next);
  }
}

// The set of states between which an AGV can drive, pick and drop for ever: of several sets, the one with most lanes
// that are driven without a load, because every AGV starts without one. Of equal sets, that with the first lane.
std::vector<bool> DriveStates::states_for_ever() const {
  const std::size_t states = 2 * map_->lanes().size();
  std::vector<Arrow> arrows;
  for (const bool loaded : {false, true}) {
    for (const auto& [lane, next] : traffic_[loaded].onward)
      arrows.push_back({state(lane, loaded), state(next, loaded)});
  }
  const std::size_t drives = arrows.size();
  for (std::uint32_t lane = 0; lane < map_->lanes().size(); ++lane) {
    if (!stops_after(lane)) continue;
    arrows.push_back({state(lane, false), state(lane, true)});
    arrows.push_back({state(lane, true), state(lane, false)});
  }
  const StrongComponents parts = strong_components(states, arrows);
  std::vector<bool> is_driven(states, false);  // by part
  for (std::size_t i = 0; i < drives; ++i) {
    const std::uint32_t part = parts.component[arrows[i].from];
    if (part == parts.component[arrows[i].to]) is_driven[part] = true;
  }
  std::vector<std::uint32_t> empty(states, 0);  // by part
  std::uint32_t most = 0, best = 0;
  for (std::uint32_t lane = 0; lane < map_->lanes().size(); ++lane)
    empty[parts.component[state(lane, false)]] += traffic_[0].permitted[lane] ? 1 : 0;
  for (std::uint32_t lane = 0; lane < map_->lanes().size(); ++lane) {
    const std::uint32_t part = parts.component[state(lane, false)];
    if (is_driven[part] && empty[part] > most) most = empty[part], best = part;
  }
  std::vector<bool> for_ever(states);
  for (std::size_t i = 0; i < states; ++i) for_ever[i] = most > 0 && parts.component[i] == best;
  return for_ever;
}

void DriveStates::find_ways(bool loaded, const std::vector<bool>& for_ever) {
  Traffic& traffic = traffic_[loaded];
  const std::size_t lanes = map_->lanes().size();
  std::vector<Arrow> onward, back;
  for (const auto& [lane, next] : traffic.onward) {
    if (!for_ever[state(lane, loaded)] || !for_ever[state(next, loaded)]) continue;
    onward.push_back({lane, next});
    back.push_back({next, lane});
  }
  const StrongComponents parts = strong_components(lanes, onward);
  std::vector<bool> tried(lanes, false);  // by part
  std::size_t most = 0;
  for (std::uint32_t lane = 0; lane < lanes; ++lane) {
    if (!for_ever[state(lane, loaded)] || tried[parts.component[lane]]) continue;
    tried[parts.component[lane]] = true;
    auto before = reached(back, lane, lanes), after = reached(onward, lane, lanes);
    const auto ways = static_cast<std::size_t>(std::ranges::count(before, true) * std::ranges::count(after, true));
    if (ways <= most) continue;
    most = ways;
    traffic.leads_there = std::move(before);
    traffic.comes_from_there = std::move(after);
  }
}

void DriveStates::find_uses(const std::vector<bool>& for_ever) {
  const auto arrives = [&](std::uint32_t lane, bool loaded) {
    return traffic_[loaded].permitted[lane] && traffic_[loaded].comes_from_there[lane];
  };
  const auto goes_on = [&](std::uint32_t lane, bool loaded) {
    bool found = false;
    for_each_next(lane, loaded, [&](std::uint32_t next) { found = found || for_ever[state(next, loaded)]; });
    return found && traffic_[loaded].leads_there[lane];
  };
  for (std::uint32_t lane = 0; lane < map_->lanes().size(); ++lane) {
    StationUse& use = uses_[map_->lanes()[lane].to.index()];
    if (for_ever[state(lane, false)] || for_ever[state(lane, true)]) use.passed = true;
    if (!stops_after(lane)) continue;
    if (arrives(lane, false) && goes_on(lane, false)) use.stopped = true;
    if (arrives(lane, false) && goes_on(lane, true)) use.picks = true;
    if (arrives(lane, true) && goes_on(lane, false)) use.drops = true;
  }
}

bool DriveStates::reaches(StationId from, StationId to, bool loaded) const {
  if (from == to) return true;
  std::vector<bool> seen(map_->lanes().size(), false);
  std::vector<std::uint32_t> open;
  const auto visit = [&](std::uint32_t lane) {
    if (seen[lane]) return;
    seen[lane] = true;
    open.push_back(lane);
  };
  for (const std::uint32_t lane : map_->lanes_from(from)) {
    if (traffic_[loaded].permitted[lane]) visit(lane);
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
