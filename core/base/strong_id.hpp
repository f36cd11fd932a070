#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace fleetproof {

// An index into one kind of thing. The compiler refuses to mix ids of different kinds.
template <class Tag>
struct StrongId {
  std::uint32_t value = std::numeric_limits<std::uint32_t>::max();

  constexpr StrongId() = default;
  constexpr explicit StrongId(std::uint32_t v) : value(v) {}
  constexpr explicit StrongId(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}

  constexpr bool valid() const { return value != std::numeric_limits<std::uint32_t>::max(); }
  constexpr std::size_t index() const { return value; }
  friend constexpr auto operator<=>(StrongId, StrongId) = default;
};

// Whatever a run has: first the AGVs (0 .. fleet-1), then the computers, the obstacles, and the loads that fall. All
// have one numbering, so that a law can name each of them by one id. A computer occupies no floor.
using EntityId = StrongId<struct EntityTag>;
using AgvId = EntityId;
using StationId = StrongId<struct StationTag>;
using SegmentId = StrongId<struct SegmentTag>;
using LoadId = StrongId<struct LoadTag>;
using TransportId = StrongId<struct TransportTag>;

}  // namespace fleetproof
