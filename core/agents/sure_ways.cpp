#include "core/agents/sure_ways.hpp"

#include <algorithm>

#include "core/agents/facts.hpp"

namespace fleetproof::agents {

SureWays::SureWays(const MapView& map, std::span<const std::byte> tables) : map_(map) {
  TableReader reader(tables);
  for (const std::uint32_t station : reader.next<std::uint32_t>()) {
    const auto there = reader.next<Place>(), back = reader.next<Place>();
    roots_.push_back({station, {there, {}}, {back, {}}});
  }
}

std::vector<std::byte> SureWays::work_out(const MapView& map, std::span<const std::uint32_t> roots) {
  TableWriter tables;
  tables.add(std::vector<std::uint32_t>(roots.begin(), roots.end()));
  for (const std::uint32_t root : roots) tables.add(grow(map, root, true)), tables.add(grow(map, root, false));
  return tables.bytes();
}

// The nearest stations first. `backwards`: the ways lead to the root. Stations without a way get numbers that no tree
// has.
std::vector<SureWays::Place> SureWays::grow(const MapView& map, std::uint32_t root, bool backwards) {
  std::vector<Place> places(map.station_count(), Place{FP_NONE, FP_NONE, FP_NONE});
  std::vector<std::uint32_t> found{root}, before(map.station_count());
  places[root] = {FP_NONE, 0, 1};
  for (std::size_t next = 0; next < found.size(); ++next) {
    const std::uint32_t at = found[next];
    for (const std::uint32_t lane : backwards ? map.lanes_to(at) : map.lanes_from(at)) {
      const std::uint32_t to = backwards ? map.lane(lane).from : map.lane(lane).to;
      if (places[to].first != FP_NONE) continue;
      places[to] = {lane, 0, 1};
      before[to] = at;
      found.push_back(to);
    }
  }
  // First, `end` is how many stations lie behind a station, itself included; then, where the numbers of the next one
  // begin.
  for (std::size_t i = found.size(); i-- > 1;) places[before[found[i]]].end += places[found[i]].end;
  std::vector<std::uint32_t> free(map.station_count(), 1);
  for (std::size_t i = 1; i < found.size(); ++i) {
    Place& place = places[found[i]];
    std::uint32_t& next = free[before[found[i]]];
    place.first = next;
    next += place.end;
    free[found[i]] = place.first + 1;
    place.end = next;
  }
  return places;
}

void SureWays::take_away(std::uint32_t station, std::span<const std::uint32_t> lanes) {
  for (Root& root : roots_) {
    for (Tree* const tree : {&root.there, &root.back}) {
      const Place& missing = tree->places[station];
      tree->broken.assign(1, {missing.first, missing.end});
      for (const std::uint32_t lane : lanes) {
        const Place& place = tree->places[tree == &root.there ? map_.lane(lane).from : map_.lane(lane).to];
        if (place.lane == lane) tree->broken.push_back({place.first, place.end});
      }
    }
  }
  std::size_t most = 0;
  const Root* best = nullptr;
  for (const Root& root : roots_) {
    const std::size_t kept = keep_those_with(root);
    if (kept == roots_.size()) return;
    if (best == nullptr || kept > most) best = &root, most = kept;
  }
  keep_those_with(*best);
}

// How many they are.
std::size_t SureWays::keep_those_with(const Root& root) {
  std::size_t kept = 0;
  for (Root& other : roots_) {
    other.stays = root.there.is_whole(other.station) && root.back.is_whole(other.station);
    kept += other.stays ? 1 : 0;
  }
  return kept;
}

bool SureWays::is_sure(std::uint32_t station, bool backwards) const {
  return std::ranges::any_of(
      roots_, [&](const Root& root) { return root.stays && (backwards ? root.back : root.there).is_whole(station); });
}

bool SureWays::Tree::is_whole(std::uint32_t station) const {
  const std::uint32_t number = places[station].first;
  return number != FP_NONE &&
         std::ranges::none_of(broken, [&](const Broken& part) { return number >= part.first && number < part.end; });
}

}  // namespace fleetproof::agents
