#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/agents/drive_rules.hpp"
#include "core/agents/hull_parts.hpp"
#include "core/agents/least_costs.hpp"
#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

// A convention for one-way lanes that run beside each other in opposite directions, as on a main aisle, and so near
// that an AGV which waits on one of them blocks the other. Two AGVs that meet there stay for ever: neither of them can
// turn back. So one of the two directions gets preferred by all AGVs, on the whole of the main aisle: the one with
// which the ways between the goals are shorter. The convention follows from map and bodies alone. It only prices
// routes: an AGV whose goal is at the other lane drives there.
class OppositeLanes {
 public:
  OppositeLanes(const MapView& map, const HullParts& parts);

  bool is_against(std::uint32_t lane) const { return against_[lane]; }

  static constexpr double kPrice = 4.0;      // so much longer counts a lane against the convention
  static constexpr std::size_t kGoals = 12;  // between so many goals the ways are measured

 private:
  // Two one-way lanes of which one is blocked by an AGV that waits at the end of the other.
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  void find_pairs(const HullParts& parts);
  void find_mains();
  void choose(std::uint32_t main, std::uint32_t other);
  double ways_m(std::uint32_t main, std::uint32_t other);
  double ways_by_rules_m(const DriveRules& rules) const;
  double ways_without_rules_m();
  double cost_m(std::uint32_t lane) const;
  void price(std::uint32_t main, std::uint32_t other, bool against);
  std::vector<std::uint32_t> goals() const;

  const MapView& map_;
  std::vector<Pair> pairs_;
  std::vector<std::uint32_t> main_of_;  // by lane: one-way lanes that go straight on belong to one main aisle
  std::vector<bool> against_;           // by lane
  std::vector<std::uint32_t> goals_;    // between which ways are measured
  std::unique_ptr<LeastCosts> least_;   // in a plant without rules
};

// By lane: whether it is against the convention, worked out once for all AGVs.
std::span<const std::uint8_t> lanes_against_opposite(const HullParts& parts);

}  // namespace fleetproof::agents
