#include "core/agents/map_without.hpp"

#include <algorithm>

#include "core/agents/facts.hpp"

namespace fleetproof::agents {

MapWithout::MapWithout(const MapView& map) : blocked_(map.lane_count(), false), seen_(map.station_count(), 0) {
  std::span<const std::byte> bytes;
  if (map.facts() == nullptr) {
    own_ = work_out(map);
    bytes = own_;
  } else {
    bytes = ask<std::byte>(
        *map.facts(),
        [](const fp_facts* from, std::uint64_t, fp_answer* to) { answer(*from, to, work_out(MapView(*from))); }, 0);
  }
  TableReader tables(bytes);
  for (Hops* const hops : {&onward_, &back_}) {
    hops->all = tables.next<Hop>();
    hops->first = tables.next<std::uint32_t>();
  }
}

std::vector<std::byte> MapWithout::work_out(const MapView& map) {
  TableWriter tables;
  for (const bool back : {false, true}) {
    std::vector<Hop> hops;
    std::vector<std::uint32_t> first;
    hops.reserve(map.lane_count()), first.reserve(map.station_count() + 1);
    for (std::uint32_t station = 0; station < map.station_count(); ++station) {
      first.push_back(static_cast<std::uint32_t>(hops.size()));
      for (const std::uint32_t lane : back ? map.lanes_to(station) : map.lanes_from(station))
        hops.push_back({lane, back ? map.lane(lane).from : map.lane(lane).to});
    }
    first.push_back(static_cast<std::uint32_t>(hops.size()));
    tables.add(hops), tables.add(first);
  }
  return tables.bytes();
}

void MapWithout::take_away(std::uint32_t station) {
  without_ = station;
  for (const std::uint32_t lane : blocked_list_) blocked_[lane] = false;
  blocked_list_.clear();
}

void MapWithout::block(std::uint32_t lane) {
  blocked_[lane] = true;
  blocked_list_.push_back(lane);
}

void MapWithout::begin_look(std::uint32_t from) {
  seen_[from] = ++look_;
  found_.assign(1, from);
}

void MapWithout::look_on(std::uint32_t at, bool backwards) {
  const Hops& hops = backwards ? back_ : onward_;
  for (std::uint32_t hop = hops.first[at]; hop < hops.first[at + 1]; ++hop) {
    const auto [lane, next] = hops.all[hop];
    if (next == without_ || was_found(next) || blocked_[lane]) continue;
    seen_[next] = look_;
    found_.push_back(next);
  }
}

}  // namespace fleetproof::agents
