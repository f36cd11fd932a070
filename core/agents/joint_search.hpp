// How an AGV gets past others that stand in its way: which of them drives which lane, one after the other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/agents/drive_rules.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/path.hpp"

namespace fleetproof::agents {

struct AgvPath {
  std::uint32_t agv = FP_NONE;
  Path path;
};

// An AGV where it stands, or will stand when it has driven all that it may. If it is out of order, its path has lanes.
struct Standing {
  std::uint32_t agv = FP_NONE;
  Path path;
  const DriveRules* rules = nullptr;
  std::span<const double> costs_s;  // by lane
  bool loaded = false;
  bool makes_way = false;  // it takes part if another one wants to pass
};

// Numbers keys in the order in which they come: a hash table in two arrays, for searches that meet many states and ask
// for each of them often. Nothing depends on the order of the slots.
template <std::size_t words>
class KeyNumbers {
 public:
  using Key = std::array<std::uint64_t, words>;

  // The number of the key, and whether it has come for the first time.
  std::pair<std::uint32_t, bool> number(const Key& key) {
    if (2 * keys_.size() >= slots_.size()) grow();
    std::uint32_t& slot = slot_of(key);
    const bool is_new = slot == kFree;
    if (is_new) {
      slot = static_cast<std::uint32_t>(keys_.size());
      keys_.push_back(key);
    }
    return {slot, is_new};
  }

 private:
  static constexpr std::uint32_t kFree = ~0U;
  static constexpr std::size_t kFirstSlots = 128;  // a power of two, as all later sizes

  std::uint32_t& slot_of(const Key& key) {
    std::uint64_t hash = 0;
    for (const std::uint64_t word : key) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 32;  // the low bits choose the slot
    }
    std::size_t at = hash & (slots_.size() - 1);
    while (slots_[at] != kFree && keys_[slots_[at]] != key) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }
  void grow() {
    slots_.assign(slots_.empty() ? kFirstSlots : 2 * slots_.size(), kFree);
    for (std::uint32_t number = 0; number < keys_.size(); ++number) slot_of(keys_[number]) = number;
  }

  std::vector<Key> keys_;             // by number
  std::vector<std::uint32_t> slots_;  // of the table: numbers of keys
};

// A search over the places at which a few AGVs stand, best first. In each move, one of them drives a lane while the
// others stand. Its hull keeps clear of theirs, and of all obstacles. So the moves can be driven one after the other,
// and two moves that keep clear of each other at the same time. Requires: map and geometry outlive the object.
class JointSearch {
 public:
  static constexpr std::size_t kMostMovers = 8;

  // The first mover is the one that has a goal. Obstacles stay where they are.
  JointSearch(const MapView& map, HullGeometry& geometry, std::vector<Standing> movers, std::vector<AgvPath> obstacles);

  // Moves after which the first mover stands at the goal, as an AGV may stay there, and all movers can leave; if that
  // is not found, one of them can. Each move is a path of one lane. Empty: they are not needed, or were not found among
  // the `most` states that look best.
  std::vector<AgvPath> find(std::uint32_t goal, std::size_t most);
  // Obstacles that a mover has met: with them among the movers, there may be more ways.
  std::span<const std::uint32_t> met() const { return met_; }

 private:
  // Where a mover stands: at the end of a lane, or where it began.
  using Place = std::uint16_t;
  using Places = std::array<Place, kMostMovers>;  // by mover
  static constexpr Place kBegin = 0xffff;
  struct State {
    Places places;
    std::uint32_t before = 0, mover = 0;
    double cost_s = 0.0;
  };
  struct Open {
    double least_s;
    std::uint32_t state;
    bool operator>(const Open& other) const { return std::tie(least_s, state) > std::tie(other.least_s, other.state); }
  };

  Path standing(std::uint32_t mover, Place place) const;
  std::uint32_t expand(std::uint32_t state);
  bool try_move(std::uint32_t state, std::uint32_t mover, const Path& from, std::uint32_t lane);
  bool is_clear(std::uint32_t mover, const Places& places, const Path& path);
  std::uint32_t obstacle_of(std::uint32_t mover, const Path& path);
  void push(const State& state);
  std::vector<AgvPath> moves_to(std::uint32_t state) const;

  const MapView& map_;
  HullGeometry& geometry_;
  std::vector<Standing> movers_;
  std::vector<AgvPath> obstacles_;
  std::span<const float> remains_s_;  // by station: the way of the first mover
  std::vector<State> states_;
  std::vector<Open> open_;   // heap, the best first
  KeyNumbers<2> known_;      // places of all states
  KeyNumbers<1> questions_;  // a move; a move and the place of another mover
  std::vector<bool> clear_;  // by question: the answer
  std::vector<std::uint32_t> met_;
};

// AGVs that stand in each other's way, and moves after which the first one, the leader, is past the others.
struct Passing {
  std::vector<std::uint32_t> agvs;
  std::vector<AgvPath> moves;  // empty: there are none, or they were not found
};

// The moves that bring the leader to its goal, or as far as it can come past a few others. `fleet`: by AGV. `promised`:
// paths on which others will drive. `most`: see JointSearch.
Passing find_passing(const MapView& map, HullGeometry& geometry, std::span<const Standing> fleet,
                     std::span<const AgvPath> promised, std::uint32_t leader, std::uint32_t goal, std::size_t most);

// A passing that is carried out: its moves that were not given yet.
struct UnderWay : Passing {
  std::uint32_t floor = 0;    // the state of the floor when it was last looked at
  std::int64_t given_ns = 0;  // when the newest move was given
};

// Gives each move as soon as it keeps clear of all earlier ones that still have to wait. `give(move)`: false if it has
// to wait. `floor`: another number whenever the floor has changed; otherwise, nothing is worked out again.
void carry_out(UnderWay& passing, HullGeometry& geometry, std::uint32_t floor, std::int64_t now_ns,
               const std::function<bool(const AgvPath&)>& give);

// Whether an AGV can drive no lane, and none of those that are in its way can: they would stay there for ever.
bool is_stuck(const MapView& map, HullGeometry& geometry, std::span<const Standing> fleet, std::uint32_t agv);

}  // namespace fleetproof::agents
