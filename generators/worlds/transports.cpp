#include "generators/worlds/transports.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <ranges>
#include <vector>

#include "core/base/random.hpp"
#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

constexpr double kFirstWithin_s = 10.0;
constexpr std::uint32_t kOfNoAgv = ~0U;                // item of draws that belong to no AGV
constexpr std::uint32_t kWithdrawnTopic = 0x77000000;  // of the transports stream, beyond any attempt
constexpr double kWithdrawnWithin_s = 300.0;

// From one station to another; the second is drawn from the rest.
TransportOrder draw_order(Draws& draws, const OrderEnds& ends) {
  const auto drawn = [&](std::size_t count) { return draws.below(static_cast<std::uint32_t>(count)); };
  const std::size_t pick = drawn(ends.picks.size());
  const StationId from = ends.picks[pick];
  const auto& drops = ends.drops_from(pick);
  const auto without = std::ranges::lower_bound(drops, from);
  const bool among = without != drops.end() && *without == from;
  const auto other = drawn(drops.size() - (among ? 1 : 0));
  return {.from = from, .to = drops[among && other >= without - drops.begin() ? other + 1 : other]};
}

// Stations with unequal shares of the traffic.
class HotSpots {
 public:
  HotSpots(const OrderEnds& ends, double skew, Draws draws) : ends_(ends) {
    std::vector<StationId> all;
    std::ranges::set_union(ends.picks, ends.drops, std::back_inserter(all));
    for (const auto n : draw_some(draws, all.size(), all.size())) {
      stations_.push_back(all[n]);
      shares_.push_back(natural_exp(-skew * natural_log(static_cast<double>(stations_.size()))));
    }
    picked_ = sums(ends.picks);
    dropped_ = sums(ends.drops);
  }

  // The second is drawn from the rest, by their shares of the rest.
  TransportOrder draw_order(Draws& draws) const {
    const auto from = at(picked_, draws.uniform() * picked_.back());
    const auto pick = std::ranges::lower_bound(ends_.picks, stations_[from]) - ends_.picks.begin();
    const auto& drops = ends_.drops_from(static_cast<std::size_t>(pick));
    const Sums own = ends_.drops_of.empty() ? Sums() : sums(drops);
    const Sums& dropped = ends_.drops_of.empty() ? dropped_ : own;
    const double before = from == 0 ? 0.0 : dropped[from - 1], share = dropped[from] - before;
    const double drawn = draws.uniform() * (dropped.back() - share);
    auto to = at(dropped, drawn < before ? drawn : drawn + share);
    if (to == from) to = beside(from, drops);  // rounding, at the edges of a share
    return {.from = stations_[from], .to = stations_[to]};
  }

 private:
  // By station: the sum of its share and all shares before it.
  using Sums = std::vector<double>;

  // Only these have a share.
  Sums sums(const std::vector<StationId>& of) const {
    Sums sums;
    double sum = 0.0;
    for (std::size_t i = 0; i < stations_.size(); ++i)
      sums.push_back(sum += std::ranges::binary_search(of, stations_[i]) ? shares_[i] : 0.0);
    return sums;
  }
  static std::size_t at(const Sums& sums, double drawn) {
    auto found = std::ranges::upper_bound(sums, drawn);
    if (found == sums.end()) found = std::ranges::lower_bound(sums, sums.back());  // rounding: the last with a share
    return static_cast<std::size_t>(found - sums.begin());
  }
  // The next of the drops, else the last one before.
  std::size_t beside(std::size_t from, const std::vector<StationId>& drops) const {
    const auto is_drop = [&](std::size_t i) { return std::ranges::binary_search(drops, stations_[i]); };
    for (std::size_t i = from + 1; i < stations_.size(); ++i) {
      if (is_drop(i)) return i;
    }
    while (!is_drop(--from)) continue;
    return from;
  }

  const OrderEnds& ends_;
  std::vector<StationId> stations_;  // in a drawn order
  std::vector<double> shares_;       // by station
  Sums picked_, dropped_;
};

// Keeps the picks from which a load can be brought to another station.
void find_pairs(OrderEnds& ends, const Reachability& reachability, std::uint32_t type) {
  std::vector<StationId> picks;
  for (const StationId from : ends.picks) {
    const auto carried = reachability.carried_from(from, type);
    std::vector<StationId> drops;
    for (const StationId to : ends.drops) {
      if (to == from || carried[to.index()]) drops.push_back(to);
    }
    if (drops.empty() || (drops.size() == 1 && drops[0] == from)) continue;
    picks.push_back(from);
    ends.drops_of.push_back(std::move(drops));
  }
  ends.picks = std::move(picks);
}

OrderEnds ends_where(const LogicalMap& map, const Reachability& reachability, std::uint32_t type,
                     bool (*suits)(const Station&)) {
  OrderEnds ends;
  for (const auto station : reachability.core()) {
    if (!suits(map.station(station))) continue;
    if (reachability.use_of(station, type).picks) ends.picks.push_back(station);
    if (reachability.use_of(station, type).drops) ends.drops.push_back(station);
  }
  if (!reachability.carries_all(type)) find_pairs(ends, reachability, type);
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
      hot_spots[type].emplace(ends[type], demand.hot_spot_skew, Draws(key, attempt, kOfNoAgv));
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

void withdraw_transports(Scenario& scenario, double share, std::uint64_t key, std::uint32_t attempt) {
  if (share <= 0.0) return;
  for (std::size_t i = 0; i < scenario.agvs.size(); ++i) {
    Draws draws(key, kWithdrawnTopic + attempt, static_cast<std::uint32_t>(i));
    for (TransportOrder& order : scenario.agvs[i].transports) {
      const bool is_withdrawn = draws.uniform() < share;
      const Duration after = seconds(draws.uniform(0.0, kWithdrawnWithin_s));
      if (is_withdrawn) order.withdrawn = order.release + after;
    }
  }
}

void open_transports(Scenario& scenario) {
  struct Opened {
    TransportOrder order;
    AgvId agv;
    std::uint32_t number;
  };
  std::vector<Opened> all;
  for (std::size_t i = 0; i < scenario.agvs.size(); ++i) {
    auto& transports = scenario.agvs[i].transports;
    for (std::uint32_t k = 0; k < transports.size(); ++k) all.push_back({transports[k], AgvId{i}, k});
    transports.clear();
  }
  std::ranges::stable_sort(all, {}, [](const Opened& opened) { return opened.order.release; });
  const auto length_m = [](const VehicleType& type) { return type.footprint_with(true).length_m; };
  const double longest_m = std::ranges::max(scenario.vehicle_types | std::views::transform(length_m));
  for (Fault& fault : scenario.faults) {
    if (!fault.transport) continue;
    const auto is_of = [&](const Opened& opened) {
      return opened.agv == fault.agv && opened.number == *fault.transport;
    };
    const AgvSetup& agv = scenario.agvs[fault.agv.index()];
    if (fault.kind == Fault::Kind::LoadDrop) fault.ahead_m -= 0.5 * (longest_m - length_m(scenario.type_of(agv)));
    fault.transport = static_cast<std::uint32_t>(std::ranges::find_if(all, is_of) - all.begin());
    fault.agv = {};
  }
  for (const Opened& opened : all) scenario.open_orders.push_back(opened.order);
}

}  // namespace fleetproof
