#pragma once

#include <cstdint>
#include <vector>

#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

// Where an AGV may stand for long. A standing AGV blocks its station and all lanes that are too near to it. The goals
// (the stations with a purpose other than routing) must still reach each other, and lanes between them must not be
// blocked. A lane that leads into a part without goals, as in front of a bay, may be blocked. A station whose lanes are
// all one-way is a waiting place too: there the AGV only holds up those behind it. Each station is judged at the first
// question.
class WaitingPlaces {
 public:
  WaitingPlaces(const MapView& map, HullGeometry& geometry);

  bool is_safe(std::uint32_t station) { return burden(station) == 0; }
  // How much an AGV that stands here blocks: the number of goals it cuts off, or kFoulsLanes and more if it blocks
  // lanes. 0: a safe place.
  std::uint32_t burden(std::uint32_t station);

  static constexpr std::uint32_t kFoulsLanes = 10'000;

 private:
  static constexpr std::uint32_t kUnknown = ~0U;
  enum Mark : std::uint8_t { kReached = 1, kReaches = 2, kInPart = 3, kInLargest = 4 };

  std::uint32_t work_out(std::uint32_t station);
  bool is_all_one_way(std::uint32_t station) const;
  void block_lanes(std::uint32_t station);
  bool is_missed(std::uint32_t station, std::uint32_t lane);
  bool blocks_while_waiting(std::uint32_t station, std::uint32_t lane);
  std::uint32_t mark_largest_part(std::uint32_t without, std::uint32_t all);
  std::uint32_t mark_part(std::uint32_t from, std::uint32_t without);
  void mark_reachable(std::uint32_t from, std::uint32_t without, bool backwards);

  const MapView& map_;
  HullGeometry& geometry_;
  std::vector<std::uint32_t> burdens_;  // by station
  std::vector<bool> goals_;             // by station
  std::uint32_t goal_count_ = 0;

  // Of the station that is being judged.
  std::vector<std::uint8_t> marks_;  // by station
  std::vector<bool> blocked_;        // by lane
  std::vector<std::uint32_t> blocked_list_, stack_;
};

}  // namespace fleetproof::agents
