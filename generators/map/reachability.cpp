#include "generators/map/reachability.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "generators/map/strong_components.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kMostTried = 64;  // parts of the map through which most ways may lead

std::vector<bool> reached(std::span<const Arrow> arrows, std::size_t from, std::size_t nodes) {
  std::vector<bool> all(nodes, false);
  all[from] = true;
  reach_along(arrows, all);
  return all;
}

// One node of each part, in the order of the ways; of many parts, some from everywhere, and the largest.
std::vector<std::size_t> some_of_each_part(const StrongComponents& parts, const std::vector<bool>& counts) {
  std::vector<std::size_t> sizes(counts.size(), 0), first(counts.size(), counts.size());  // by part
  for (std::size_t node = counts.size(); node-- > 0;) {
    if (counts[node]) ++sizes[parts.component[node]], first[parts.component[node]] = node;
  }
  std::vector<std::size_t> all, some;
  for (const std::size_t node : first) {
    if (node < counts.size()) all.push_back(node);
  }
  if (all.empty()) return some;
  some.push_back(first[static_cast<std::size_t>(std::ranges::max_element(sizes) - sizes.begin())]);
  const std::size_t tried = std::min(kMostTried, all.size());
  for (std::size_t i = 0; i < tried; ++i) some.push_back(all[i * all.size() / tried]);
  return some;
}

}  // namespace

DriveStates::DriveStates(const LogicalMap& map, std::string vehicle_type)
    : map_(&map), vehicle_type_(std::move(vehicle_type)), uses_(map.station_count()) {
  for (const bool loaded : {false, true}) {
    for (const Lane& lane : map.lanes())
      traffic_[loaded].permitted.push_back(map.segment(lane.segment).permits(vehicle_type_, loaded));
  }
  find_states_for_ever();
  find_ways(false);
  find_ways(true);
  find_uses();
}

// At a station where AGVs turn, it does not matter how an AGV stands.
bool DriveStates::may_start_along(std::uint32_t lane) const {
  const StationId from = map_->lanes()[lane].from;
  const std::size_t node = map_->station(from).turning ? map_->lanes().size() + from.index() : lane;
  return traffic_[0].permitted[lane] && traffic_[0].leads_there[node];
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

// From lane to lane.
std::vector<Arrow> DriveStates::onward(bool loaded) const {
  std::vector<Arrow> arrows;
  for (std::uint32_t lane = 0; lane < map_->lanes().size(); ++lane)
    for_each_next(lane, loaded, [&](std::uint32_t next) { arrows.push_back({lane, next}); });
  return arrows;
}

// The set of states between which an AGV can drive, pick and drop for ever: of several sets, the one with most lanes
// that are driven without a load, because every AGV starts without one. Of equal sets, that with the first lane.
void DriveStates::find_states_for_ever() {
  const std::size_t states = 2 * map_->lanes().size();
  std::vector<Arrow> arrows;
  for (const bool loaded : {false, true}) {
    for (const auto& [lane, next] : onward(loaded)) arrows.push_back({state(lane, loaded), state(next, loaded)});
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
  for (std::size_t i = 0; i < states; ++i) for_ever_.push_back(most > 0 && parts.component[i] == best);
}

// Nodes are the lanes, and after them the stations where AGVs may turn: there, every lane leads to every other.
void DriveStates::find_ways(bool loaded) {
  const std::size_t lanes = map_->lanes().size(), nodes = lanes + map_->station_count();
  std::vector<bool> counts(nodes, false);
  std::vector<Arrow> onward, back;
  const auto join = [&](std::size_t from, std::size_t to) {
    onward.push_back({static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to)});
    back.push_back({static_cast<std::uint32_t>(to), static_cast<std::uint32_t>(from)});
    counts[from] = counts[to] = true;
  };
  for (std::uint32_t lane = 0; lane < lanes; ++lane) {
    if (!for_ever_[state(lane, loaded)]) continue;
    const Lane& driven = map_->lanes()[lane];
    if (map_->station(driven.from).turning && traffic_[loaded].permitted[lane]) join(lanes + driven.from.index(), lane);
    if (map_->station(driven.to).turning) {
      join(lane, lanes + driven.to.index());
    } else {
      for_each_next(lane, loaded, [&](std::uint32_t next) {
        if (for_ever_[state(next, loaded)]) join(lane, next);
      });
    }
  }
  Traffic& traffic = traffic_[loaded];
  traffic.comes_from_there = traffic.leads_there = std::vector<bool>(nodes, false);
  std::size_t most = 0;
  for (const std::size_t node : some_of_each_part(strong_components(nodes, onward), counts)) {
    auto before = reached(back, node, nodes), after = reached(onward, node, nodes);
    const auto ways = static_cast<std::size_t>(std::ranges::count(before, true) * std::ranges::count(after, true));
    if (ways <= most) continue;
    most = ways;
    traffic.leads_there = std::move(before);
    traffic.comes_from_there = std::move(after);
  }
}

void DriveStates::find_uses() {
  const std::vector<bool> none(uses_.size(), false);
  std::vector<bool> stuck_loaded = none, stuck_empty = none, feeds = none, fed = none;  // by station
  for (std::uint32_t lane = 0; lane < map_->lanes().size(); ++lane) {
    const std::size_t to = map_->lanes()[lane].to.index();
    StationUse& use = uses_[to];
    const auto arrives = [&](bool loaded) {
      return for_ever_[state(lane, loaded)] && traffic_[loaded].permitted[lane];
    };
    const auto goes_on = [&](bool loaded) {
      bool found = false;
      for_each_next(lane, loaded, [&](std::uint32_t next) { found = found || for_ever_[state(next, loaded)]; });
      return found;
    };
    if (for_ever_[state(lane, false)] || for_ever_[state(lane, true)]) use.passed = true;
    if (may_start_along(lane)) uses_[map_->lanes()[lane].from.index()].started = true;
    if (!stops_after(lane) || !(arrives(false) || arrives(true))) continue;
    const bool back_there = goes_on(false) && traffic_[0].leads_there[lane];
    if (arrives(false) && traffic_[0].comes_from_there[lane]) {
      use.stopped = use.stopped || back_there;
      use.picks = use.picks || goes_on(true);
    }
    if (arrives(false) && !goes_on(true)) stuck_loaded[to] = true;
    use.drops = use.drops || (arrives(true) && back_there);
    if (arrives(true) && !back_there) stuck_empty[to] = true;
    if (traffic_[1].leads_there[lane]) feeds[to] = true;
    if (arrives(true) && traffic_[1].comes_from_there[lane]) fed[to] = true;
  }
  carries_all_ = true;
  for (std::size_t i = 0; i < uses_.size(); ++i) {
    StationUse& use = uses_[i];
    use.started = use.started && use.passed;
    use.picks = use.picks && !stuck_loaded[i];
    use.drops = use.drops && !stuck_empty[i];
    if ((use.picks && !feeds[i]) || (use.drops && !fed[i])) carries_all_ = false;
  }
}

std::vector<bool> DriveStates::driven_from(const std::vector<std::uint32_t>& first, bool loaded,
                                           const std::vector<bool>* among) const {
  std::vector<bool> driven(map_->lanes().size(), false);
  std::vector<std::uint32_t> open;
  const auto visit = [&](std::uint32_t lane) {
    if (driven[lane] || !traffic_[loaded].permitted[lane] || (among != nullptr && !(*among)[state(lane, loaded)]))
      return;
    driven[lane] = true;
    open.push_back(lane);
  };
  for (const std::uint32_t lane : first) visit(lane);
  while (!open.empty()) {
    const std::uint32_t lane = open.back();
    open.pop_back();
    for_each_next(lane, loaded, visit);
  }
  return driven;
}

bool DriveStates::reaches(StationId from, StationId to, bool loaded) const {
  if (from == to) return true;
  const auto driven = driven_from(map_->lanes_from(from), loaded, nullptr);
  for (std::uint32_t lane = 0; lane < driven.size(); ++lane) {
    if (driven[lane] && map_->lanes()[lane].to == to && stops_after(lane)) return true;
  }
  return false;
}

std::vector<bool> DriveStates::carried_from(StationId from) const {
  std::vector<std::uint32_t> first;
  for (std::uint32_t lane = 0; lane < map_->lanes().size(); ++lane) {
    if (map_->lanes()[lane].to == from && traffic_[0].permitted[lane] && for_ever_[state(lane, false)] &&
        stops_after(lane))
      for_each_next(lane, true, [&](std::uint32_t next) { first.push_back(next); });
  }
  const auto driven = driven_from(first, true, &for_ever_);
  std::vector<bool> stations(uses_.size(), false);
  for (std::uint32_t lane = 0; lane < driven.size(); ++lane) {
    if (driven[lane] && stops_after(lane)) stations[map_->lanes()[lane].to.index()] = true;
  }
  return stations;
}

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
