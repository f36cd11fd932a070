#include "generators/transports.hpp"

#include "core/random.hpp"

namespace fleetproof {
namespace {

constexpr double kFirstWithin_s = 10.0;

// From one station to another; the second is drawn from the rest.
TransportOrder draw_order(Draws& draws, const std::vector<StationId>& stations) {
  const auto count = static_cast<std::uint32_t>(stations.size());
  const auto from = draws.below(count);
  const auto other = draws.below(count - 1);
  return {stations[from], stations[other < from ? other : other + 1], {}};
}

}  // namespace

bool assign_transports(Scenario& scenario, double transports_per_agv_hour, const Reachability& reachability, std::uint64_t key,
                       std::uint32_t attempt) {
  std::vector<StationId> stations;
  for (const auto station : reachability.core()) {
    if (scenario.map->station(station).purposes.has(Purpose::Storage)) stations.push_back(station);
  }
  const bool enough = stations.size() >= 2;
  if (!enough) stations = reachability.core();
  if (stations.size() < 2 || transports_per_agv_hour <= 0.0) return enough;
  const double mean_s = 3600.0 / transports_per_agv_hour, horizon_s = to_seconds(scenario.horizon);
  for (std::size_t i = 0; i < scenario.agvs.size(); ++i) {
    Draws draws(key, attempt, static_cast<std::uint32_t>(i));
    auto& transports = scenario.agvs[i].transports;
    transports.clear();
    for (double t_s = draws.uniform(0.0, kFirstWithin_s); t_s < horizon_s; t_s += draws.exponential(mean_s)) {
      auto order = draw_order(draws, stations);
      order.release = seconds(t_s);
      transports.push_back(order);
    }
  }
  return enough;
}

}  // namespace fleetproof
