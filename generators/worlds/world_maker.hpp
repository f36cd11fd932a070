#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/scenario/scenario.hpp"
#include "generators/map/rejection_counts.hpp"
#include "generators/worlds/drawn_faults.hpp"
#include "generators/worlds/order_list.hpp"
#include "generators/worlds/placement.hpp"
#include "generators/worlds/transports.hpp"

namespace fleetproof {

// A vehicle type, and its share of the fleet relative to the other types.
struct VehicleShare {
  VehicleType type;
  double share = 1.0;
};

// Held streams. The streams listed here take their seeds from the world that `seed` would draw if nothing were held. A
// held layout is therefore the same layout in every world. The result of a stream may depend on other streams: if
// placement is held but the layout is not, the start stations differ between worlds.
struct HeldStreams {
  std::vector<Stream> streams;  // of kRunStreams, in that order
  std::uint64_t seed = 0;
};

// What a campaign fixes for all of its worlds. The seed draws the rest.
struct WorldSpec {
  // The name of a family and its range (family_range()): every world gets a new layout. Or one map, which all worlds
  // share.
  std::variant<std::string, std::shared_ptr<const LogicalMap>> layout = std::string("aisle-grid");
  bool mutate = false;  // every world gets a mutation of the map (mutated_import.hpp)
  std::uint32_t fleet_size = 5;
  Placement placement = Placement::Random;
  Demand demand;
  OrderSetup order_setup;
  std::shared_ptr<const OrderList>
      orders;  // instead of drawn transports; only with an unchanged map and without placement in pairs
  std::vector<VehicleShare> vehicles{VehicleShare{}};  // at least one; the type of every AGV is drawn from them
  FaultRates faults;
  LawSetup law;  // starts keep its safety distance
  Duration horizon = kUsualHorizon;
  HeldStreams held;
};

// Thrown if 32 draws of a world leave no room for the fleet.
class NoRoom : public InputError {
 public:
  NoRoom(std::string_view what, std::uint32_t that_fit)
      : InputError("fleet_size", what), sentence(what), fits(that_fit) {}
  std::string sentence;
  std::uint32_t fits;  // the number of AGVs for which there is room; 0: not known
};

// Draws a world: a pure function of spec and seed. Layout, placement and transports have their own streams. If the
// validator refuses a world, the next draw replaces it, and `counts` counts the refusal. Radio and agent clock keep
// their defaults; the caller sets them. Throws InputError if the spec is not usable, and NoRoom.
Scenario generate_world(const WorldSpec& spec, std::uint64_t seed, RejectionCounts& counts);

// What was refused, and how often: "out of stations 3, weak-core 2". Empty if nothing was refused.
std::string rejection_text(const RejectionCounts& counts);

}  // namespace fleetproof
