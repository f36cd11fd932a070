#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

// A convention that keeps AGVs from meeting in narrow aisles. An aisle is a chain of two-way segments between two
// stations at which ways branch; dead ends beside it do not count. An aisle in which AGVs stop at goals, and would
// often meet, gets one direction that all AGVs prefer, if there is a way round for the other direction: all stations
// still reach each other without a lane against the convention. If the goals lie in bays beside the aisle, AGVs wait
// there for each other, and ways round would only cost time. The convention follows from the map and the size of the
// fleet alone, so all AGVs have the same one without a message. It only prices routes: where the way round is long, an
// AGV drives against it.
class Aisles {
 public:
  Aisles(const MapView& map, std::uint32_t fleet_count);

  bool is_against(std::uint32_t lane) const { return against_[lane]; }

  // Aisles of fewer segments are left two-way: an AGV waits at their end until the other one is through.
  static constexpr std::uint32_t kFewestSegments = 4;
  // In shorter aisles, AGVs meet so rarely that ways round cost more. If the other AGVs of the fleet were spread evenly
  // over the map, so many of them would be in the aisle.
  static constexpr double kOthersInside = 0.15;

 private:
  // One direction of an aisle. Lanes of one segment and direction, such as forward and backward, are one lane here.
  using Way = std::vector<std::uint32_t>;

  void find_dead_ends();
  std::vector<Way> find_aisles() const;
  bool has_goals(const Way& way) const;
  double length_m(const Way& way) const;
  std::uint32_t degree(std::uint32_t station) const;
  std::uint32_t lane_back(std::uint32_t lane) const;
  std::uint32_t next_in_aisle(std::uint32_t lane) const;
  Way along(std::uint32_t first) const;
  Way opposite(const Way& way) const;
  double way_round_m(const Way& closed, double limit_m);
  std::vector<std::uint32_t> lanes_beside(std::uint32_t lane) const;
  void set_against(const Way& way, bool against);

  const MapView& map_;
  std::vector<bool> against_;     // by lane
  std::vector<bool> dead_end_;    // by station
  std::vector<double> so_far_m_;  // by station
};

// By lane: whether it is against the convention, worked out once for all AGVs.
std::span<const std::uint8_t> lanes_against_aisles(const fp_facts& facts);

}  // namespace fleetproof::agents
