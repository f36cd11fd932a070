#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

inline constexpr std::uint32_t kPathLanesMax = 64;

// A way through the map: an AGV stands at `station` with `heading` and drives `lanes` one after the other. On a path
// without lanes, the AGV stands.
struct Path {
  std::uint32_t station = 0;
  Vec heading{1.0, 0.0};
  std::uint32_t count = 0;
  std::array<std::uint16_t, kPathLanesMax> lane_ids;  // as on the wire, where larger numbers have no room

  Path() = default;
  Path(const Path& other) { *this = other; }
  // Most paths are short.
  Path& operator=(const Path& other) {
    station = other.station;
    heading = other.heading;
    count = other.count;
    std::copy_n(other.lane_ids.begin(), count, lane_ids.begin());
    return *this;
  }

  std::span<const std::uint16_t> lanes() const { return {lane_ids.data(), count}; }
  bool empty() const { return count == 0; }
  // False if the path is full.
  bool append(std::uint32_t lane) {
    if (count == kPathLanesMax) return false;
    lane_ids[count++] = static_cast<std::uint16_t>(lane);
    return true;
  }
};

bool operator==(const Path& a, const Path& b);
// Equal, and with exactly the same heading: then the hulls are the same, too.
bool is_identical(const Path& a, const Path& b);
// True if every lane exists and begins where the lane before it ends.
bool is_driveable(const MapView& map, const Path& path);
// A path without lanes, at the end of this path.
Path end_of(const MapView& map, const Path& path);
// Appends the lane that leaves the end of the path by this segment, named as in actions. False if there is none.
bool append_segment(const MapView& map, Path& path, std::uint32_t segment);
double length_m(const MapView& map, const Path& path);
// True if the AGV stands at one station or passes it on both paths.
bool share_a_station(const MapView& map, const Path& a, const Path& b);
// Removes the first lane; the path then begins at the end of that lane. Requires: the path is not empty.
void pass_first_lane(const MapView& map, Path& path);

}  // namespace fleetproof::agents
