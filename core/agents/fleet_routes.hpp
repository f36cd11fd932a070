#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/agents/drive_rules.hpp"
#include "core/agents/hull_parts.hpp"
#include "core/agents/lane_prices.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/path.hpp"
#include "core/agents/routes.hpp"
#include "core/agents/waiting_places.hpp"

namespace fleetproof::agents {

// Searches ways for each AGV of a fleet. AGVs of one model share rules and prices: set the prices anew before the
// searches for another AGV. Requires: map and parts outlive the object.
class FleetRoutes {
 public:
  FleetRoutes(const MapView& map, const HullParts& parts);

  const DriveRules& rules(std::uint32_t agv) const { return models_[agv]->rules; }
  LanePrices& prices(std::uint32_t agv) { return models_[agv]->prices; }
  // The lanes of the quickest way at the present prices. Empty: there is none, or the AGV is there. This answer and the
  // next one are valid until the next search.
  std::span<const std::uint32_t> way(std::uint32_t agv, const Path& from, std::uint32_t goal);
  // The way to the first station that is good, of those in the order of their costs.
  std::span<const std::uint32_t> way_to_first(std::uint32_t agv, const Path& from,
                                              const std::function<bool(std::uint32_t station)>& is_good);
  std::uint32_t charger(std::uint32_t agv, const Path& from, WaitingPlaces& places, bool urgent,
                        const std::function<bool(std::uint32_t station)>& is_taken);
  // The cost of the way between two stations, without prices.
  double usual_cost_s(std::uint32_t agv, std::uint32_t from, std::uint32_t to) const;
  // For driving the path without a stop but for turns, as an estimate.
  double takes_s(std::uint32_t agv, const Path& path) const;

 private:
  struct Model {
    Model(const MapView& map, const HullParts& parts, std::uint32_t number);
    DriveRules rules;
    Routes routes;
    LanePrices prices;
    std::uint32_t number;
  };

  const MapView& map_;
  const HullParts& parts_;
  std::vector<std::shared_ptr<Model>> models_;  // by AGV
};

// The charging station that is quickest to reach after a search of `routes`, if possible one at which an AGV blocks no
// other. If it is `urgent`, also one that is taken: an AGV that is charged enough makes room. FP_NONE: there is none.
std::uint32_t quickest_charger(const MapView& map, const Routes& routes, WaitingPlaces& places, bool urgent,
                               const std::function<bool(std::uint32_t station)>& is_taken);

}  // namespace fleetproof::agents
