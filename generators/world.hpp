#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "core/scenario.hpp"
#include "generators/rejection_counts.hpp"

namespace fleetproof {

// What a campaign fixes about its worlds; the seed draws the rest.
struct WorldSpec {
  // Name of a family (layout_family.hpp): a new layout in every world. Or one map, built once and shared by all of them.
  std::variant<std::string, std::shared_ptr<const LogicalMap>> layout = std::string("aisle-grid");
  std::uint32_t fleet_size = 5;
  double transports_per_agv_hour = 20.0;  // 0: none; at most 3600
  VehicleType vehicle;
  LawSetup law;  // starts keep its safety distance
  Duration horizon = std::chrono::seconds(600);
};

// A pure function of spec and seed: layout, placement and transports from their own streams. A world that the validator refuses is
// replaced by the next draw; counts are added to `counts`. Radio and agent clock keep their defaults, for the caller to set.
// InputError if the spec is unusable or the fleet finds no place in 32 draws.
Scenario generate_world(const WorldSpec& spec, std::uint64_t seed, RejectionCounts& counts);

}  // namespace fleetproof
