#include "generators/map/waiting_room.hpp"

#include <algorithm>
#include <cstdint>

namespace fleetproof {
namespace {

// Stations of the core that `from` reaches along the lanes, or against them, without passing `without`; `from`
// included.
class Search {
 public:
  Search(const LogicalMap& map, const Reachability& reachability)
      : map_(map), reachability_(reachability), lanes_to_(map.station_count()) {
    for (std::uint32_t i = 0; i < map.lanes().size(); ++i) lanes_to_[map.lanes()[i].to.index()].push_back(i);
  }

  std::size_t count(StationId from, StationId without, bool forwards) {
    seen_.assign(map_.station_count(), false);
    seen_[from.index()] = seen_[without.index()] = true;
    open_.assign(1, from);
    std::size_t found = 0;
    while (!open_.empty()) {
      const StationId here = open_.back();
      open_.pop_back();
      ++found;
      for (const auto lane : forwards ? map_.lanes_from(here) : lanes_to_[here.index()]) {
        const StationId next = forwards ? map_.lanes()[lane].to : map_.lanes()[lane].from;
        if (seen_[next.index()] || !reachability_.in_core(next)) continue;
        seen_[next.index()] = true;
        open_.push_back(next);
      }
    }
    return found;
  }

 private:
  const LogicalMap& map_;
  const Reachability& reachability_;
  std::vector<std::vector<std::uint32_t>> lanes_to_;
  std::vector<bool> seen_;
  std::vector<StationId> open_;
};

bool cuts(Search& search, StationId station, const Reachability& reachability) {
  const auto& core = reachability.core();
  if (core.size() < 3) return false;
  const StationId from = core[0] == station ? core[1] : core[0];
  return search.count(from, station, true) + 1 < core.size() || search.count(from, station, false) + 1 < core.size();
}

// First two places of storage, so that there are transports; then one place to park and one to charge.
std::vector<std::size_t> in_order_of_need(const Layout& layout) {
  std::vector<std::size_t> order;
  for (const auto& [purpose, count] :
       {std::pair{Purpose::Storage, 2}, {Purpose::Parking, 1}, {Purpose::Charging, 1}, {Purpose::Storage, 1'000'000}}) {
    int taken = 0;
    for (std::size_t i = 0; i < layout.stations.size() && taken < count; ++i) {
      if (!layout.stations[i].purposes.has(purpose) || std::ranges::find(order, i) != order.end()) continue;
      order.push_back(i);
      ++taken;
    }
  }
  for (std::size_t i = 0; i < layout.stations.size(); ++i) {
    if (is_place_to_wait(layout.stations[i]) && std::ranges::find(order, i) == order.end()) order.push_back(i);
  }
  return order;
}

}  // namespace

bool is_place_to_wait(const Station& station) {
  return station.purposes.has(Purpose::Parking) || station.purposes.has(Purpose::Charging) ||
         station.purposes.has(Purpose::Storage);
}

std::vector<bool> cut_stations(const LogicalMap& map, const Reachability& reachability) {
  std::vector<bool> cut(map.station_count(), false);
  Search search(map, reachability);
  for (const auto station : reachability.core()) cut[station.index()] = cuts(search, station, reachability);
  return cut;
}

bool has_open_waiting_place(const LogicalMap& map, const Reachability& reachability) {
  Search search(map, reachability);
  return std::ranges::any_of(reachability.core(), [&](StationId s) {
    return is_place_to_wait(map.station(s)) && !cuts(search, s, reachability);
  });
}

bool close_waiting_places(Layout& layout) {
  const LogicalMap map(layout);
  const auto cut = cut_stations(map, Reachability(map));
  auto stations = layout.stations;
  for (const auto i : in_order_of_need(layout)) {
    if (cut[i]) continue;
    Station* nearest = nullptr;
    const auto distance = [&](const Station& s) { return (s.position_m - stations[i].position_m).squaredNorm(); };
    for (std::size_t k = 0; k < cut.size(); ++k) {
      auto& candidate = stations[k];
      if (cut[k] && !is_place_to_wait(candidate) && (nearest == nullptr || distance(candidate) < distance(*nearest)))
        nearest = &candidate;
    }
    if (nearest != nullptr) nearest->purposes = stations[i].purposes;
    stations[i].purposes = Purpose::Routing;
  }
  if (std::ranges::count_if(stations, [](const Station& s) { return s.purposes.has(Purpose::Storage); }) < 2)
    return false;
  layout.stations = std::move(stations);
  return true;
}

}  // namespace fleetproof
