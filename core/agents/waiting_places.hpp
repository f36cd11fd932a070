#pragma once

#include <cstdint>
#include <vector>

#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/map_without.hpp"

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
  static constexpr std::size_t kSmallPiece = 60;  // stations
  enum Mark : std::uint8_t { kReached = 1, kReaches = 2, kInPart = 3, kInLargest = 4 };

  std::uint32_t work_out(std::uint32_t station);
  bool is_all_one_way(std::uint32_t station) const;
  void block_lanes(std::uint32_t station);
  bool cuts_off_pieces_only(std::uint32_t station, std::uint32_t others);
  bool is_cut_off(std::uint32_t station) const { return cut_off_[station] == judged_; }
  bool has_detours(std::uint32_t station);
  bool is_missed(std::uint32_t station, std::uint32_t lane, bool only_pieces);
  bool blocks_while_waiting(std::uint32_t station, std::uint32_t lane);
  std::uint32_t mark_largest_part(std::uint32_t without, std::uint32_t all);
  std::uint32_t mark_part(std::uint32_t from);

  const MapView& map_;
  HullGeometry& geometry_;
  std::vector<std::uint32_t> burdens_;  // by station
  std::vector<bool> goals_;             // by station
  std::uint32_t goal_count_ = 0;
  bool goals_are_connected_ = false;      // if nothing is blocked
  std::vector<std::uint8_t> free_marks_;  // by station: of the part with the goals, if nothing is blocked

  // Of the station that is being judged.
  MapWithout without_;
  std::vector<std::uint8_t> marks_;     // by station
  std::vector<std::uint32_t> cut_off_;  // by station: the last judgement by which it was in a small piece
  std::uint32_t judged_ = 0, goals_in_pieces_ = 0;
};

}  // namespace fleetproof::agents
