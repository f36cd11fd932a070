#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "core/agents/hull_lock.hpp"
#include "tests/agents/drawn_map.hpp"
#include "tests/agents/fake_warehouse.hpp"

namespace fleetproof::agents::testing {

// Four arms of one crossing, with two bays at the end of each: AGVs start in the first bay of their arm.
struct Junction {
  Junction() {
    const auto centre = drawn.station(0, 0);
    for (const auto& [x, y] : {std::pair(1.0, 0.0), {0.0, 1.0}, {-1.0, 0.0}, {0.0, -1.0}}) {
      const auto arm = drawn.station(6 * x, 6 * y);
      drawn.segment(centre, arm);
      const auto first = drawn.station(6 * x - 3.5 * y, 6 * y + 3.5 * x, FP_STORAGE),
                 second = drawn.station(6 * x + 3.5 * y, 6 * y - 3.5 * x, FP_STORAGE);
      drawn.segment(arm, first), drawn.segment(arm, second);
      bays.push_back({first, second});
    }
    drawn.map();
  }
  std::uint32_t start(std::uint32_t agv) const { return bays[agv].first; }
  std::uint32_t opposite(std::uint32_t agv) const { return bays[(agv + 2) % 4].second; }

  DrawnMap drawn;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> bays;
};

struct Tally {
  std::uint32_t runs = 0, conflicting_holds = 0, claims_too_long = 0, places_not_held = 0, violations = 0, drops = 0,
                locks = 0;
  std::uint32_t overtaken = 0, restarts = 0, restarts_on_lanes = 0, misplaced = 0;
  double latest_drop_s = 0.0;
};

// True if the path begins where the AGV stands, or with the lanes that the AGV drives and will drive.
inline bool begins_where_it_is(const FakeWarehouse& warehouse, const MapView& map, std::uint32_t id, const Path& held) {
  const fp_lane *lane = warehouse.lane_of(id), *next = warehouse.next_of(id);
  if (held.station != warehouse.station_of(id) || !is_driveable(map, held)) return false;
  if (lane != nullptr && (held.empty() || &map.lane(held.lane_ids[0]) != lane)) return false;
  return next == nullptr || (held.count > 1 && &map.lane(held.lane_ids[1]) == next);
}

// Watches what AGVs hold. It contains the place of the AGV. When an AGV holds more, no other AGV may hold anything that
// conflicts with it. No AGV claims more than the longest claim.
inline void watch_holds(FakeWarehouse& warehouse, const TestFleet& fleet, Tally& tally) {
  struct Watch {
    Watch(const TestFleet& fleet, std::size_t count)
        : map(fleet.map), geometry(map, fleet.briefing(0, 0)), held(count), boots(count), seen(count), locked(count) {}
    MapView map;
    HullGeometry geometry;
    std::vector<std::uint32_t> held;  // lanes
    std::vector<std::uint32_t> boots;
    std::vector<bool> seen;
    std::vector<Path> locked;
  };
  auto watch = std::make_shared<Watch>(fleet, warehouse.fleet_size());
  warehouse.after_activation = [&warehouse, &tally, watch](std::uint32_t id) {
    const LockProtocol& protocol = static_cast<const HullLock*>(warehouse.agent(id))->protocol();
    const Path& mine = protocol.held();
    const double requested_m = protocol.requesting() ? length_m(watch->map, protocol.requested()) : 0.0;
    tally.claims_too_long += length_m(watch->map, mine) + requested_m > longest_claim_m(watch->map);
    tally.places_not_held += !begins_where_it_is(warehouse, watch->map, id, mine);
    const bool restarted = warehouse.boot_of(id) != watch->boots[id];
    const bool more = !restarted && mine.count > watch->held[id];
    tally.restarts += restarted;
    tally.restarts_on_lanes += restarted && mine.count > 0;
    // An AGV that restarts on a lane may also hold the turn before the lane. Its former held path says whether it had
    // locked the turn.
    Path& locked = watch->locked[id];
    const bool same_lane =
        mine.count > 0 && locked.count > 0 && mine.lane_ids[0] == locked.lane_ids[0] && mine.station == locked.station;
    const Vec heading = locked.heading;
    const bool reversed = mine.count > 0 && dot(mine.heading, watch->map.start_heading(mine.lane_ids[0])) < -1.0 + 1e-9;
    locked = mine;
    watch->seen[id] = true;
    if (same_lane && reversed && warehouse.boot_of(id) > 0) locked.heading = heading;
    watch->held[id] = mine.count;
    watch->boots[id] = warehouse.boot_of(id);
    if (!more) return;
    ++tally.locks;
    for (std::uint32_t other = 0; other < warehouse.fleet_size(); ++other) {
      if (other == id || !watch->seen[other]) continue;
      if (watch->geometry.conflict(id, locked, other, watch->locked[other])) ++tally.conflicting_holds;
    }
  };
}

inline void finish(const FakeWarehouse& warehouse, Tally& tally) {
  ++tally.runs;
  tally.violations += warehouse.least_clearance_m() < 0.10 - 1e-6;
  tally.drops += warehouse.drops();
  tally.misplaced += warehouse.misplaced();
  tally.overtaken += warehouse.probes().contains("overtaken");
  tally.latest_drop_s = std::max(tally.latest_drop_s, warehouse.last_drop_s());
}

}  // namespace fleetproof::agents::testing
