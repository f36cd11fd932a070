#include "generators/worlds/transports.hpp"

#include <algorithm>
#include <optional>

#include "core/base/random.hpp"
#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

constexpr double kFirstWithin_s = 10.0;
constexpr std::uint32_t kNoAgv = ~0U;  // item of draws that belong to no AGV

// From one station to another; the second is drawn from the rest.
TransportOrder draw_order(Draws& draws, const std::vector<StationId>& stations) {
  const auto count = static_cast<std::uint32_t>(stations.size());
  const auto from = draws.below(count);
  const auto other = draws.below(count - 1);
  return {stations[from], stations[other < from ? other : other + 1], {}};
}

// Stations with unequal shares of the traffic.
class HotSpots {
 public:
  HotSpots(const std::vector<StationId>& stations, double skew, Draws draws) {
    double sum = 0.0;
    for (const auto n : draw_some(draws, stations.size(), stations.size())) {
      stations_.push_back(stations[n]);
      sum += natural_exp(-skew * natural_log(static_cast<double>(stations_.size())));
      sums_.push_back(sum);
    }
  }

  // The second is drawn from the rest, by their shares of the rest.
  TransportOrder draw_order(Draws& draws) const {
    const auto from = at(draws.uniform() * sums_.back());
    const double before = from == 0 ? 0.0 : sums_[from - 1], share = sums_[from] - before;
    const double drawn = draws.uniform() * (sums_.back() - share);
    auto to = at(drawn < before ? drawn : drawn + share);
    if (to == from) to = from + 1 < stations_.size() ? from + 1 : from - 1;  // rounding, at the edges of a share
    return {stations_[from], stations_[to], {}};
  }

 private:
  std::size_t at(double drawn) const {
    const auto found = std::ranges::upper_bound(sums_, drawn);
    return std::min(static_cast<std::size_t>(found - sums_.begin()), sums_.size() - 1);
  }

  std::vector<StationId> stations_;
  std::vector<double> sums_;
};

}  // namespace

bool may_end_orders(const Station& station) {
  return station.purposes.has(Purpose::Storage) ||
         !(station.purposes.has(Purpose::Charging) || station.purposes.has(Purpose::Parking));
}

std::vector<StationId> order_ends(const LogicalMap& map, const Reachability& reachability) {
  std::vector<StationId> storage, allowed;
  for (const auto station : reachability.core()) {
    if (map.station(station).purposes.has(Purpose::Storage)) storage.push_back(station);
    if (may_end_orders(map.station(station))) allowed.push_back(station);
  }
  if (storage.size() >= 2) return storage;
  return allowed.size() >= 2 ? allowed : reachability.core();
}

bool assign_transports(Scenario& scenario, const Demand& demand, const Reachability& reachability, std::uint64_t key,
                       std::uint32_t attempt) {
  const auto stations = order_ends(*scenario.map, reachability);
  const bool enough = stations.size() >= 2 && scenario.map->station(stations[0]).purposes.has(Purpose::Storage) &&
                      scenario.map->station(stations[1]).purposes.has(Purpose::Storage);
  if (stations.size() < 2 || demand.transports_per_agv_hour <= 0.0) return enough;
  std::optional<HotSpots> hot_spots;
  if (demand.hot_spot_skew > 0.0) hot_spots.emplace(stations, demand.hot_spot_skew, Draws(key, attempt, kNoAgv));
  const double mean_s = 3600.0 / demand.transports_per_agv_hour, horizon_s = to_seconds(scenario.horizon);
  for (std::size_t i = 0; i < scenario.agvs.size(); ++i) {
    Draws draws(key, attempt, static_cast<std::uint32_t>(i));
    auto& transports = scenario.agvs[i].transports;
    transports.clear();
    for (double t_s = draws.uniform(0.0, kFirstWithin_s); t_s < horizon_s; t_s += draws.exponential(mean_s)) {
      auto order = hot_spots ? hot_spots->draw_order(draws) : draw_order(draws, stations);
      order.release = seconds(t_s);
      transports.push_back(order);
    }
  }
  return enough;
}

}  // namespace fleetproof
