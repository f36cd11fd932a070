// Where an AGV may wait: what an AGV that stands at a station blocks, and what is still connected without it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/hull.hpp"
#include "core/agents/hull_parts.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/sure_ways.hpp"

namespace fleetproof::agents {

// The map without one station, and without lanes that are blocked: what still reaches what.
class MapWithout {
 public:
  explicit MapWithout(const MapView& map);

  // Takes another station away (FP_NONE: no station). No lane is blocked then.
  void take_away(std::uint32_t station);
  void block(std::uint32_t lane);
  std::span<const std::uint32_t> blocked() const { return blocked_list_; }

  // What a search does at a station that it has found.
  enum class Look : std::uint8_t { On, NotBeyond, Stop };

  // Finds the stations that `from` reaches, or that reach it.
  void explore(std::uint32_t from, bool backwards) {
    explore(from, backwards, [](std::uint32_t) { return Look::On; });
  }
  // The same, but asks `look(station)` how to go on. False if it was told to stop.
  template <class F>
  bool explore(std::uint32_t from, bool backwards, F look) {
    begin_look(from);
    for (std::size_t next = 0; next < found_.size(); ++next) {
      const Look how = look(found_[next]);
      if (how == Look::Stop) return false;
      if (how == Look::On) look_on(found_[next], backwards);
    }
    return true;
  }
  // Of the last search, if it was not told to stop.
  std::span<const std::uint32_t> found() const { return found_; }

 private:
  struct Hop {
    std::uint32_t lane, to;
  };
  // All hops in one array, by the station that they leave. A search reads many, and a lane of the map is much larger.
  struct Hops {
    std::span<const Hop> all;
    std::span<const std::uint32_t> first;  // by station, and one more
  };
  static std::vector<std::byte> work_out(const MapView& map);

  bool was_found(std::uint32_t station) const { return seen_[station] == look_; }
  void begin_look(std::uint32_t from);
  void look_on(std::uint32_t at, bool backwards);

  std::vector<std::byte> own_;  // the hops, if they are not shared
  Hops onward_, back_;
  std::uint32_t without_ = FP_NONE;
  std::vector<bool> blocked_;  // by lane
  std::vector<std::uint32_t> blocked_list_;
  std::vector<std::uint32_t> seen_;  // by station: the last look that came there
  std::uint32_t look_ = 0;
  std::vector<std::uint32_t> found_;
};

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

// Where an AGV may stand for long. Each station is judged at the first question, once for all AGVs of the run.
// Requires: map and geometry outlive the object.
class WaitingPlaces {
 public:
  WaitingPlaces(const MapView& map, const HullGeometry& geometry)
      : parts_(geometry.parts()), burdens_(map.station_count(), kUnknown) {}

  bool is_safe(std::uint32_t station) { return burden(station) == 0; }
  // How much an AGV that stands here blocks: see PlaceJudge.
  std::uint32_t burden(std::uint32_t station) {
    std::uint32_t& known = burdens_[station];
    if (known == kUnknown) known = burden_of(parts_, station);
    return known;
  }

 private:
  static constexpr std::uint32_t kUnknown = ~0U;

  const HullParts& parts_;
  std::vector<std::uint32_t> burdens_;  // by station
};

}  // namespace fleetproof::agents
