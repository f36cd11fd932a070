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

}  // namespace fleetproof::agents
