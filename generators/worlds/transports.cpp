#include "generators/worlds/transports.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

#include "core/base/random.hpp"
#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

constexpr double kFirstWithin_s = 10.0;
constexpr std::uint32_t kNoAgv = ~0U;  // item of draws that belong to no AGV

// From one station to another; the second is drawn from the rest.
TransportOrder draw_order(Draws& draws, const OrderEnds& ends) {
  const auto drawn = [&](std::size_t count) { return draws.below(static_cast<std::uint32_t>(count)); };
  const StationId from = ends.picks[drawn(ends.picks.size())];
  const auto without = std::ranges::lower_bound(ends.drops, from);
  const bool among = without != ends.drops.end() && *without == from;
  const auto other = drawn(ends.drops.size() - (among ? 1 : 0));
  return {from, ends.drops[among && other >= without - ends.drops.begin() ? other + 1 : other], {}};
}

// Stations with unequal shares of the traffic.
class HotSpots {
 public:
  HotSpots(const OrderEnds& ends, double skew, Draws draws) {
    std::vector<StationId> all;
    std::ranges::set_union(ends.picks, ends.drops, std::back_inserter(all));
    double picked = 0.0, dropped = 0.0;
    for (const auto n : draw_some(draws, all.size(), all.size())) {
      stations_.push_back(all[n]);
      drops_.push_back(std::ranges::binary_search(ends.drops, all[n]));
      const double share = natural_exp(-skew * natural_log(static_cast<double>(stations_.size())));
      picked_.push_back(picked += std::ranges::binary_search(ends.picks, all[n]) ? share : 0.0);
      dropped_.push_back(dropped += drops_.back() ? share : 0.0);
    }
  }

  // The second is drawn from the rest, by their shares of the rest.
  TransportOrder draw_order(Draws& draws) const {
    const auto from = at(picked_, draws.uniform() * picked_.back());
    const double before = share_before(dropped_, from), share = dropped_[from] - before;
    const double drawn = draws.uniform() * (dropped_.back() - share);
    auto to = at(dropped_, drawn < before ? drawn : drawn + share);
    if (to == from) to = beside(from);  // rounding, at the edges of a share
    return {stations_[from], stations_[to], {}};
  }

 private:
  // By station: the sum of its share and all shares before it.
  using Sums = std::vector<double>;

  static double share_before(const Sums& sums, std::size_t i) { return i == 0 ? 0.0 : sums[i - 1]; }
  static std::size_t at(const Sums& sums, double drawn) {
    auto found = std::ranges::upper_bound(sums, drawn);
    if (found == sums.end()) found = std::ranges::lower_bound(sums, sums.back());  // rounding: the last with a share
    return static_cast<std::size_t>(found - sums.begin());
  }
  // The next station where transports end, else the last one before.
  std::size_t beside(std::size_t from) const {
    for (std::size_t i = from + 1; i < stations_.size(); ++i) {
      if (drops_[i]) return i;
    }
    while (!drops_[--from]) continue;
    return from;
  }

  std::vector<StationId> stations_;
  std::vector<bool> drops_;  // by station: whether transports end there
  Sums picked_, dropped_;
};

OrderEnds ends_where(const LogicalMap& map, const Reachability& reachability, std::uint32_t type,
                     bool (*suits)(const Station&)) {
  OrderEnds ends;
  for (const auto station : reachability.core()) {
    if (!suits(map.station(station))) continue;
    if (reachability.use_of(station, type).picks) ends.picks.push_back(station);
    if (reachability.use_of(station, type).drops) ends.drops.push_back(station);
  }
  if (ends.drops.size() == 1) std::erase(ends.picks, ends.drops[0]);
  if (ends.picks.empty() || ends.drops.empty()) return {};
  return ends;
}

}  // namespace

bool may_end_orders(const Station& station) {
  return station.purposes.has(Purpose::Storage) ||
         !(station.purposes.has(Purpose::Charging) || station.purposes.has(Purpose::Parking));
}

OrderEnds order_ends(const LogicalMap& map, const Reachability& reachability, std::uint32_t type) {
  OrderEnds ends = ends_where(map, reachability, type,
                              [](const Station& station) { return station.purposes.has(Purpose::Storage); });
  ends.storage = !ends.picks.empty();
  if (ends.picks.empty()) ends = ends_where(map, reachability, type, may_end_orders);
  if (ends.picks.empty()) ends = ends_where(map, reachability, type, [](const Station&) { return true; });
  return ends;
}

std::vector<OrderEnds> order_ends_by_type(const Scenario& scenario, const Reachability& reachability) {
  std::vector<OrderEnds> ends;
  for (std::uint32_t type = 0; type < scenario.vehicle_types.size(); ++type)
    ends.push_back(order_ends(*scenario.map, reachability, type));
  return ends;
}

bool assign_transports(Scenario& scenario, const Demand& demand, const Reachability& reachability, std::uint64_t key,
                       std::uint32_t attempt) {
  const auto ends = order_ends_by_type(scenario, reachability);
  const bool stored = std::ranges::all_of(ends, &OrderEnds::storage);
  if (demand.transports_per_agv_hour <= 0.0) return stored;
  std::vector<std::optional<HotSpots>> hot_spots(ends.size());
  for (std::size_t type = 0; type < ends.size() && demand.hot_spot_skew > 0.0; ++type) {
    if (!ends[type].picks.empty())
      hot_spots[type].emplace(ends[type], demand.hot_spot_skew, Draws(key, attempt, kNoAgv));
  }
  const double mean_s = 3600.0 / demand.transports_per_agv_hour, horizon_s = to_seconds(scenario.horizon);
  for (std::size_t i = 0; i < scenario.agvs.size(); ++i) {
    Draws draws(key, attempt, static_cast<std::uint32_t>(i));
    const std::uint32_t type = scenario.agvs[i].type;
    auto& transports = scenario.agvs[i].transports;
    transports.clear();
    if (ends[type].picks.empty()) continue;
    for (double t_s = draws.uniform(0.0, kFirstWithin_s); t_s < horizon_s; t_s += draws.exponential(mean_s)) {
      auto order = hot_spots[type] ? hot_spots[type]->draw_order(draws) : draw_order(draws, ends[type]);
      order.release = seconds(t_s);
      transports.push_back(order);
    }
  }
  return stored;
}

}  // namespace fleetproof
