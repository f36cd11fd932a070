#pragma once

#include <cstdint>

#include "core/agents/facts.hpp"
#include "core/agents/hull_parts.hpp"
#include "core/agents/lock_options.hpp"
#include "core/agents/path.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// Hulls: all the floor that an AGV may cover while it drives a path, as shapes. The hull of a path has parts: the
// sweeps of each turn on the spot and of each lane. A path without lanes has the standing body only.
class HullGeometry {
 public:
  // Requires: map and briefing outlive the object.
  HullGeometry(const MapView& map, const fp_briefing& briefing, HullOptions options = {})
      : map_(map), facts_(briefing), parts_(map, facts_.shared(), {options, briefing.self}) {}

  // True if the hulls of the two paths come closer than the safety distance plus the tolerance.
  bool conflict(std::uint32_t agv_a, const Path& a, std::uint32_t agv_b, const Path& b);
  // So many lanes of a path keep clear of the other path. Requires: the path has lanes.
  std::uint32_t clear_lanes(std::uint32_t agv_a, const Path& a, std::uint32_t agv_b, const Path& b);
  // As `conflict`, for one lane, or for turning at one station.
  bool lane_conflict(std::uint32_t agv_a, std::uint32_t lane, std::uint32_t agv_b, const Path& b);
  bool turn_conflict(std::uint32_t agv_a, std::uint32_t station, std::uint32_t agv_b, const Path& b);
  bool turns_conflict(std::uint32_t agv_a, std::uint32_t station_a, std::uint32_t agv_b, std::uint32_t station_b) {
    return parts_.conflict(parts_.of_turn(agv_a, station_a), parts_.of_turn(agv_b, station_b));
  }
  // A way from `station` that is shorter than this keeps clear of the other path: its hull, and a turn at its end, of
  // the other hull and of a turn at the end of the other path. May be negative.
  double meets_after_m(std::uint32_t agv_a, std::uint32_t station, std::uint32_t agv_b, const Path& b) const;
  // A lower bound of the distance from `point_m` to the hull.
  double distance_bound_m(Vec point_m, std::uint32_t agv, const Path& path);

  // Calls `f(box)` for boxes that together contain the hull.
  template <class F>
  void for_each_box(std::uint32_t agv, const Path& path, F f) const {
    Parts parts;
    collect(agv, path, parts);
    for (std::uint32_t i = 0; i < parts.count; ++i) f(parts_.box(parts.numbers[i]));
    if (parts.count == 0) f(Box::around(parts.body));
  }

  // From the reference point of the AGV to its farthest corner.
  double reach_m(std::uint32_t agv) const { return parts_.body(agv).reach_m(); }
  double clearance_m() const { return parts_.clearance_m(); }
  const HullParts& parts() const { return parts_; }

 private:
  // The parts of one path. `body` is used only if there are no parts.
  struct Parts {
    std::uint32_t count = 0;
    std::uint32_t numbers[2 * kPathLanesMax];
    Shape body;
  };
  struct Hull {
    std::uint32_t agv = FP_NONE;
    Path path;
    Parts parts;
    Box box;  // around the parts
  };

  // From its first station; the hull of the path lies within.
  double extent_m(std::uint32_t agv, const Path& path) const;
  bool is_far(std::uint32_t number, std::uint32_t agv, const Path& path) const;
  void collect(std::uint32_t agv, const Path& path, Parts& parts) const;
  const Hull& hull_of(std::uint32_t agv, const Path& path);
  Box box_around(const Parts& parts) const;
  bool part_conflicts(std::uint32_t number, const Parts& others);

  const MapView& map_;
  Facts facts_;
  HullParts parts_;
  Hull last_;  // an AGV compares one path of its own with those of many others
};

}  // namespace fleetproof::agents
