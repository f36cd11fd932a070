#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/hull_parts.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/map_without.hpp"
#include "core/agents/sure_ways.hpp"

namespace fleetproof::agents {

// The stations between which AGVs carry: those with a purpose other than routing, or all if there are none.
struct Goals {
  std::span<const std::uint8_t> is_goal;     // by station
  std::span<const std::uint8_t> free_marks;  // by station: of the part with all goals, if nothing is blocked
  std::uint32_t count = 0;
  bool are_connected = false;  // if nothing is blocked
};

// Judges a station as a place to stand for long. A standing AGV blocks its station and all lanes that are too near to
// it. The goals must still reach each other, and two-way lanes between them must not be blocked. A lane that leads into
// a part without goals, as in front of a bay, may be blocked. A station whose lanes are all one-way is a waiting place
// too: there the AGV only holds up those behind it. Other one-way lanes may be blocked as well, unless AGVs go on
// the other way from there. Requires: map and parts outlive the object.
class PlaceJudge {
 public:
  PlaceJudge(const MapView& map, const HullParts& parts);

  // The number of goals that an AGV cuts off which stands here, and kFoulsLanes more if it blocks lanes. 0: a safe
  // place.
  std::uint32_t burden(std::uint32_t station);

  static constexpr std::uint32_t kFoulsLanes = 10'000;

 private:
  // What is known of a station without the one that is judged: it reaches the rest of the map no more, or is not
  // reached from there; whether both are known; and that it does reach the rest, or is reached.
  enum Side : std::uint8_t {
    kDoomed = 1,
    kUnreached = 2,
    kCutOff = 3,
    kSeen = 4,
    kStillReaches = 8,
    kStillReached = 16
  };

  bool is_all_one_way(std::uint32_t station) const;
  void block_lanes(std::uint32_t station);
  bool cuts_off_pieces_only(std::uint32_t station, std::uint32_t others);
  void cut_off_around(std::uint32_t end);
  bool misses_any(std::uint32_t station, std::span<const std::uint32_t> lanes, bool only_pieces);
  bool is_missed(std::uint32_t station, std::uint32_t lane, bool only_pieces);
  bool leads_against(std::uint32_t station, std::uint32_t lane) const;
  bool blocks_while_waiting(std::uint32_t station, std::uint32_t lane) const;
  std::uint32_t find_largest_part(std::uint32_t without, std::uint32_t others);
  std::uint32_t goals_connected_with(std::uint32_t station, std::uint32_t others);
  bool reaches(std::uint32_t from, std::uint32_t to);

  const MapView& map_;
  const HullParts& parts_;
  Goals goals_;

  // Of the station that is being judged.
  MapWithout without_;
  SureWays sure_;
  std::vector<std::uint8_t> sides_;           // by station: whether it is in a piece
  std::vector<std::uint32_t> seen_, pieces_;  // stations beside what is missing, and those in pieces
  std::uint32_t goals_in_pieces_ = 0;
  std::uint32_t part_ = FP_NONE;         // a station of the largest part
  std::vector<std::uint8_t> is_inside_;  // by station
};

// What PlaceJudge says, worked out once for all AGVs.
std::uint32_t burden_of(const HullParts& parts, std::uint32_t station);

}  // namespace fleetproof::agents
