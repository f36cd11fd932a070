#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/agents/lanes_near.hpp"
#include "core/agents/lock_options.hpp"
#include "core/agents/path.hpp"
#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::agents {

// Hulls keep this distance in addition to the safety distance. It covers rounding in messages, turns that are too small
// to count, and arcs that are not quite the track, of bodies that reach 4.5 m from their reference points.
inline constexpr double kHullTolerance_m = 0.02;
// By this angle a body may point elsewhere than the arcs say (the map gives arcs to 2e-3 rad). Two bodies that reach
// further need more distance.
inline constexpr double kArcHeading_rad = 2.2e-3;

// Hulls: all the floor that an AGV may cover while it drives a path, as shapes. The hull of a path has parts: a disc
// for each turn on the spot, and the sweep of every lane. A path without lanes has the standing body only. Parts, and
// conflicts between them, are computed when they are first needed. Only pairs near each other are remembered, so the
// memory grows with the number of lanes, not with its square.
class HullGeometry {
 public:
  HullGeometry(const MapView& map, const fp_briefing& briefing, HullOptions options = {});

  // True if the hulls of the two paths come closer than the safety distance plus the tolerance.
  bool conflict(std::uint32_t agv_a, const Path& a, std::uint32_t agv_b, const Path& b);
  // The same for one lane, or for turning at one station.
  bool lane_conflict(std::uint32_t agv_a, std::uint32_t lane, std::uint32_t agv_b, const Path& b);
  bool turn_conflict(std::uint32_t agv_a, std::uint32_t station, std::uint32_t agv_b, const Path& b);
  bool turns_conflict(std::uint32_t agv_a, std::uint32_t station_a, std::uint32_t agv_b, std::uint32_t station_b) {
    return parts_conflict(turn_part(agv_a, station_a), turn_part(agv_b, station_b));
  }
  // True if, for some pair of AGV types, turning at `station` conflicts with driving on `lane`.
  bool turning_blocks_lane(std::uint32_t station, std::uint32_t lane);
  // All lanes for which that may be true, and some others, by ascending number.
  std::span<const std::uint32_t> lanes_near(std::uint32_t station) const { return lanes_near_->around(station); }
  // The same for standing at `station` with this heading.
  bool standing_blocks_lane(std::uint32_t station, Vec heading, std::uint32_t lane);
  // A lower bound of the distance from `point_m` to the hull.
  double distance_bound_m(Vec point_m, std::uint32_t agv, const Path& path);

  // From the reference point of the AGV to its farthest corner.
  double reach_m(std::uint32_t agv) const { return kinds_[kind_of_[agv]].reach_m(); }
  double clearance_m() const { return clearance_m_; }

 private:
  struct Part {
    std::uint32_t first = 0, count = 0;  // in shapes_; count 0: not computed yet
    Vec centre_m;                        // of a disc that contains the part
    double reach_m = 0.0;
  };
  struct Pair {
    std::uint32_t other = 0;  // the part with the larger number
    bool conflict = false;
  };
  // The parts of one path. `body` is used only if there are no parts.
  struct Parts {
    std::uint32_t count = 0;
    std::uint32_t numbers[2 * kPathLanesMax];
    Shape body;
  };

  std::uint32_t lane_part(std::uint32_t agv, std::uint32_t lane) const {
    return kind_of_[agv] * parts_per_kind_ + lane;
  }
  std::uint32_t turn_part(std::uint32_t agv, std::uint32_t station) const {
    return kind_of_[agv] * parts_per_kind_ + map_.lane_count() + station;
  }
  void collect(std::uint32_t agv, const Path& path, Parts& parts) const;
  void bound_parts(const Body& kind);
  const Part& with_shapes(std::uint32_t number);
  void work_out(std::uint32_t number, Part& part);
  bool parts_conflict(std::uint32_t a, std::uint32_t b);
  bool shapes_conflict(const Part& a, const Part& b) const;
  bool part_conflicts(std::uint32_t number, const Parts& others);
  bool body_conflicts(const Shape& body, std::uint32_t number);

  const MapView& map_;
  HullOptions options_;
  std::vector<std::uint32_t> kind_of_;  // by AGV
  std::vector<Body> kinds_;             // different footprints
  std::uint32_t parts_per_kind_;
  double clearance_m_;
  std::vector<Part> parts_;
  std::vector<Shape> shapes_;
  std::optional<LanesNear> lanes_near_;         // always there
  std::vector<std::vector<Pair>> known_pairs_;  // by the smaller part number; ordered by the other
};

}  // namespace fleetproof::agents
