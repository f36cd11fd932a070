#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/strong_id.hpp"
#include "core/base/words.hpp"
#include "core/geometry/pose.hpp"

namespace fleetproof {

// What a block asks of control software: at most one vehicle inside, or all in one direction (openTCS blocks, RMF
// mutexes).
enum class BlockKind : std::uint8_t { OneVehicle = 0, SameDirection = 1 };
constexpr const char* name_of(BlockKind kind) {
  switch (kind) {
    case BlockKind::OneVehicle:
      return "one-vehicle";
    case BlockKind::SameDirection:
      return "same-direction";
  }
  return kNoWord;
}

// Which end of the AGV goes first. Either: the agent chooses.
enum class Travel : std::uint8_t { Forward = 0, Backward = 1, Either = 2 };
constexpr const char* name_of(Travel travel) {
  switch (travel) {
    case Travel::Forward:
      return "forward";
    case Travel::Backward:
      return "backward";
    case Travel::Either:
      return "either";
  }
  return kNoWord;
}

enum class LoadState : std::uint8_t { Any = 0, Empty = 1, Loaded = 2 };
constexpr const char* name_of(LoadState state) {
  switch (state) {
    case LoadState::Any:
      return "any";
    case LoadState::Empty:
      return "empty";
    case LoadState::Loaded:
      return "loaded";
  }
  return kNoWord;
}

// Who may drive a segment.
struct Permission {
  std::string vehicle_type{};  // its name; empty: every type
  LoadState load = LoadState::Any;

  friend bool operator==(const Permission&, const Permission&) = default;
};

// A named set of segments. Agents are told of it. No law checks that they keep it; laws judge distances and loads.
struct SegmentBlock {
  std::string name{};
  BlockKind kind = BlockKind::OneVehicle;
};

// An edge of the logical map. AGVs drive it from `from` to `to`. A bidirectional segment is also driven in the other
// direction.
struct Segment {
  std::string name{};
  StationId from{}, to{};
  bool bidirectional = false;
  // None: straight; 2 for each cubic Bezier, and the joints between (2, 5, 8, ...).
  std::vector<Vec2> control_points_m{};
  // From `from` to `to`, and back. 0: no limit but the vehicle's own.
  double speed_limit_mps = 0.0, back_speed_limit_mps = 0.0;
  double width_m = 0.0;                 // of the drawn floor, for pages alone; 0: not known
  std::vector<std::uint32_t> blocks{};  // to which it belongs, by place in Layout::blocks, ascending
  Travel travel = Travel::Forward, back_travel = Travel::Forward;  // from `from` to `to`, and back
  std::vector<Permission> permissions{};  // an AGV needs one of them, in both directions; none listed: all may drive it

  bool has_properties() const {
    return speed_limit_mps > 0.0 || back_speed_limit_mps > 0.0 || width_m > 0.0 || !blocks.empty();
  }
  // What came later than the properties above, and has a part of its own in digests.
  bool has_rules() const { return travel != Travel::Forward || back_travel != Travel::Forward || !permissions.empty(); }
  // An empty `vehicle_type` has the permissions of every type.
  bool permits(std::string_view vehicle_type, bool loaded) const;
};

}  // namespace fleetproof
