#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/motion/piece.hpp"
#include "core/scenario/layout.hpp"
#include "laws/encounter.hpp"

namespace fleetproof {

// The ways on which AGVs have driven, and how often drives on two of them have met. A way is a curve with the size of
// the body that drives it. How two ways meet is the same each time: meetings are counted, and judged once, at the end.
class DrivenWays {
 public:
  using Number = std::uint32_t;  // of a way, from 0 on

  // Tracks meet if less than `margin_m` and half their widths lie between them.
  DrivenWays(const LogicalMap& map, double margin_m);

  // Requires: the piece is a drive; its curve outlives the object.
  Number number_of(const Piece& drive);
  // Contains the points of the way's track (encounter.hpp).
  const Box& box_of(Number way) const { return ways_[way].box; }
  void meet(Number earlier, Number later);

  // How many pairs of drives met in each way.
  struct Meetings {
    std::array<std::uint64_t, kEncounterKinds> encounters{};
    std::array<std::uint64_t, kSceneKinds> scenes{};
  };
  Meetings meetings() const;

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Way {
    const Curve* curve = nullptr;
    SegmentId segment;
    Footprint footprint;
    Box box;
    Number next = kNone;          // on the same segment
    std::uint32_t pairs = kNone;  // the first one in which it is the later way
  };
  struct Pair {
    Number earlier = kNone, later = kNone;
    std::uint32_t next = kNone;  // with the same later way
    std::uint64_t times = 1;
  };
  class Judge;
  bool is_of_map(const Way& way) const { return way.segment.index() < map_.segment_count(); }
  // The station at which the way ends. Requires: its segment is one of the map.
  StationId end_of(const Way& way) const;

  const LogicalMap& map_;
  double margin_m_;
  std::vector<Number> first_;  // by segment, and last of those without a segment of the map
  std::vector<Way> ways_;
  std::vector<Pair> pairs_;
};

}  // namespace fleetproof
