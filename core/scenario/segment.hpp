#pragma once

#include <cstdint>
#include <string>
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

// A named set of segments. Agents are told of it. No law checks that they keep it; laws judge distances and loads.
struct SegmentBlock {
  std::string name{};
  BlockKind kind = BlockKind::OneVehicle;
};

// An edge of the logical map. AGVs drive it from `from` to `to`, nose first. A bidirectional segment is also driven in
// the other direction.
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

  bool has_properties() const {
    return speed_limit_mps > 0.0 || back_speed_limit_mps > 0.0 || width_m > 0.0 || !blocks.empty();
  }
};

}  // namespace fleetproof
