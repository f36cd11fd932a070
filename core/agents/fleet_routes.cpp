#include "core/agents/fleet_routes.hpp"

#include <cmath>

#include "core/agents/fleet.hpp"
#include "core/agents/lane_costs.hpp"

namespace fleetproof::agents {
namespace {

constexpr double kTurnTakes_s = 3.0;  // expected
// In a row of chargers, wide AGVs cannot turn beside each other. An AGV would rather hold up others there than run
// empty.
constexpr double kUnsafeChargerCost_s = 30.0;
constexpr double kTakenCost_s = 1000.0;  // as much as no way

}  // namespace

FleetRoutes::Model::Model(const MapView& map, const HullParts& parts, std::uint32_t of)
    : rules(map, tells_minor_2(parts.facts()) ? agv_of(parts.facts(), of).vehicle_type : 0),
      routes(map, rules),
      prices(map, rules, lane_costs_s(parts, of), parts.facts().fleet_count),
      number(of) {}

FleetRoutes::FleetRoutes(const MapView& map, const HullParts& parts) : map_(map), parts_(parts) {
  for (std::uint32_t agv = 0; agv < parts.facts().fleet_count; ++agv) {
    const std::uint32_t model = model_of(parts.facts(), agv);
    models_.push_back(model < agv ? models_[model] : std::make_shared<Model>(map, parts, agv));
  }
}

std::span<const std::uint32_t> FleetRoutes::way(std::uint32_t agv, const Path& from, std::uint32_t goal) {
  Model& model = *models_[agv];
  const auto remains_s = remaining_costs_s(parts_, model.number, goal);
  model.routes.search_towards(goal, remains_s, from.station, from.heading, model.prices.costs_s());
  return model.routes.lanes(goal);
}

std::span<const std::uint32_t> FleetRoutes::way_to_first(std::uint32_t agv, const Path& from,
                                                         const std::function<bool(std::uint32_t station)>& is_good) {
  Model& model = *models_[agv];
  std::uint32_t found = FP_NONE;
  const auto look_at = [&](std::uint32_t station, double) {
    if (is_good(station)) found = station;
    return found != FP_NONE;
  };
  model.routes.search_until(look_at, from.station, from.heading, model.prices.costs_s());
  return found == FP_NONE ? std::span<const std::uint32_t>() : model.routes.lanes(found);
}

std::uint32_t FleetRoutes::charger(std::uint32_t agv, const Path& from, WaitingPlaces& places, bool urgent,
                                   const std::function<bool(std::uint32_t station)>& is_taken) {
  Model& model = *models_[agv];
  model.routes.search(from.station, from.heading, model.prices.costs_s());
  return quickest_charger(map_, model.routes, places, urgent, is_taken);
}

double FleetRoutes::usual_cost_s(std::uint32_t agv, std::uint32_t from, std::uint32_t to) const {
  return double{remaining_costs_s(parts_, models_[agv]->number, to)[from]};
}

double FleetRoutes::takes_s(std::uint32_t agv, const Path& path) const {
  const fp_agv& like = agv_of(parts_.facts(), agv);
  double sum_s = 0.0;
  Vec heading = path.heading;
  for (const std::uint32_t lane : path.lanes()) {
    if (!same_heading(heading, map_.start_heading(lane))) sum_s += kTurnTakes_s;
    sum_s += map_.lane(lane).length_m / lane_speed_mps(map_, lane, like);
    heading = map_.end_heading(lane);
  }
  return sum_s;
}

std::uint32_t quickest_charger(const MapView& map, const Routes& routes, WaitingPlaces& places, bool urgent,
                               const std::function<bool(std::uint32_t station)>& is_taken) {
  std::uint32_t best = FP_NONE;
  double best_s = urgent ? 2.0 * kTakenCost_s : kTakenCost_s;
  for (std::uint32_t station = 0; station < map.station_count(); ++station) {
    if ((map.station(station).purposes & FP_CHARGING) == 0 || routes.cost_s(station) >= best_s) continue;
    const double cost_s = routes.cost_s(station) + (places.is_safe(station) ? 0.0 : kUnsafeChargerCost_s) +
                          (is_taken(station) ? kTakenCost_s : 0.0);
    if (cost_s < best_s) best = station, best_s = cost_s;
  }
  return best;
}

}  // namespace fleetproof::agents
