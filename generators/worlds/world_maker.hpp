#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/base/random.hpp"
#include "core/scenario/scenario.hpp"
#include "generators/map/rejection_counts.hpp"
#include "generators/worlds/drawn_faults.hpp"
#include "generators/worlds/order_list.hpp"
#include "generators/worlds/placement.hpp"

namespace fleetproof {

// A kind of vehicle and how much of the fleet is of it, relative to the others.
struct VehicleShare {
  VehicleType type;
  double share = 1.0;
};

// Streams that are those of another world, the one that the same spec holding nothing has for `seed`: a layout that is
// held is the same layout, whatever else is drawn on it. What a stream amounts to may hang on others: placement that is
// held on a layout that is not gives other starts.
struct HeldStreams {
  std::vector<Stream> streams;  // of kRunStreams, in that order
  std::uint64_t seed = 0;
};

// What a campaign fixes about its worlds; the seed draws the rest.
struct WorldSpec {
  // Name of a family and its range (family_range()): a new layout in every world. Or one map, built once and shared by
  // all of them.
  std::variant<std::string, std::shared_ptr<const LogicalMap>> layout = std::string("aisle-grid");
  bool mutate = false;  // a map is only where to begin: every world has a mutation of it (mutated_import.hpp)
  std::uint32_t fleet_size = 5;
  Placement placement = Placement::Random;
  double transports_per_agv_hour = 20.0;  // 0: none; at most 3600
  double hot_spot_skew = 0.0;             // at most 4; transports.hpp
  std::shared_ptr<const OrderList>
      orders;  // instead of drawn transports; for a map that stays as it is, and no placement in pairs
  std::vector<VehicleShare> vehicles{VehicleShare{}};  // at least one; every AGV is drawn from them
  FaultRates faults;
  LawSetup law;  // starts keep its safety distance
  Duration horizon = std::chrono::seconds(600);
  HeldStreams held;
};

// A pure function of spec and seed: layout, placement and transports from their own streams. A world that the validator
// refuses is replaced by the next draw; counts are added to `counts`. Radio and agent clock keep their defaults, for
// the caller to set. InputError if the spec is unusable or the fleet finds no place in 32 draws.
Scenario generate_world(const WorldSpec& spec, std::uint64_t seed, RejectionCounts& counts);

// What was refused and how often: "out of stations 3, weak-core 2"; empty if nothing was.
std::string rejection_text(const RejectionCounts& counts);

}  // namespace fleetproof
