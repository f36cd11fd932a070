#pragma once

#include <cstdint>
#include <variant>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/motion/piece.hpp"

namespace fleetproof {

// An activity is a piece of dynamism (Sect. 3.3): which entities evolve, in which interval, and how. The numbers are
// part of the trace digest.
enum class ActivityKind : std::uint8_t { Drive = 1, Turn, Transmit, Pick, Drop, Park, Charge, Settle, Dock };
const char* name_of(ActivityKind kind);

// Where a load is: the containment relation (Sect. 3.2). A load on the floor is a body. A load that is cleared away, or
// whose transport is withdrawn before an AGV takes the load up, has left the warehouse for good.
struct Holder {
  enum class Kind : std::uint8_t { Station, Agv, Floor, ClearedAway, Withdrawn } kind = Kind::Station;
  std::uint32_t index = 0;  // of the station, the AGV, or the body
  constexpr bool is_gone() const { return kind == Kind::ClearedAway || kind == Kind::Withdrawn; }
  friend bool operator==(const Holder&, const Holder&) = default;
};

// Evolution strategies.
struct SpatialEvolution {  // drive, turn: the spatial relation of the AGV, and its battery by the distance travelled
  Piece piece;
};
struct ContainmentEvolution {  // pick, drop: a load passes from one holder to the other when the activity ends; no
                               // load: an empty move
  LoadId load;
  Holder to;
};
struct BatteryEvolution {  // charge: linear in time, up to full
  double per_s = 0.0;
};
struct Standing {};  // park, settle, dock

struct Activity {
  ActivityKind kind = ActivityKind::Park;
  AgvId agv;
  SimTime begin, end;  // the planned end; an activity that is cut short ends earlier, in the true state
  std::variant<Standing, SpatialEvolution, ContainmentEvolution, BatteryEvolution> evolution;
};

}  // namespace fleetproof
