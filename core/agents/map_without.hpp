#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

// The map without one station, and without lanes that are blocked: what still reaches what.
class MapWithout {
 public:
  explicit MapWithout(const MapView& map);

  // Takes another station away (FP_NONE: no station). No lane is blocked then.
  void take_away(std::uint32_t station);
  void block(std::uint32_t lane);
  std::span<const std::uint32_t> blocked() const { return blocked_list_; }

  // Whether `from` reaches all of these; backwards, whether all of them reach it.
  bool reaches(std::uint32_t from, std::span<const std::uint32_t> all, bool backwards);
  // Finds the stations that `from` reaches, or that reach it. False if there are more than `most`.
  bool explore(std::uint32_t from, bool backwards, std::size_t most = SIZE_MAX);
  // Of the last call of `explore`, if it returned true.
  std::span<const std::uint32_t> found() const { return found_; }
  bool was_found(std::uint32_t station) const { return seen_[station] == look_; }

 private:
  struct Hop {
    std::uint32_t lane, to;
  };
  // The hops from each station, in one table: lanes of the map are large, and each search reads many.
  struct Hops {
    std::span<const Hop> all;
    std::span<const std::uint32_t> first;  // by station, and one more
  };
  static std::vector<std::byte> work_out(const MapView& map);

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

}  // namespace fleetproof::agents
