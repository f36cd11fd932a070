#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include "core/geometry/broad_phase.hpp"
#include "core/motion/piece.hpp"
#include "core/scenario/layout.hpp"
#include "laws/encounter.hpp"

namespace fleetproof {

// The ways on which AGVs have driven, and how often drives on two of them have met. A way is a curve with the size of
// the body that drives it. How two ways meet is the same each time: meetings are counted, and judged once, at the end.
class DrivenWays {
 public:
  using Number = std::uint32_t;  // of a way, from 0 on

  // So long after its end, a drive can still be met.
  static constexpr Duration kLookAhead = std::chrono::seconds(10);

  // Tracks meet if less than `margin_m` and half their widths lie between them.
  DrivenWays(const LogicalMap& map, std::size_t agvs, double margin_m);

  // A piece of a drive begins. The first one counts how the drive meets those of other AGVs that began before it. More
  // pieces on the same curve belong to the same drive, as long as it can be met: parts of a bend, or what follows a
  // short stop. Requires: the curve outlives the object; pieces are in the order in which they begin.
  void begins(const Piece& piece);
  // The AGV does something else from `t` on.
  void ends(EntityId agv, SimTime t);

  Number number_of(const Piece& drive);
  // Counts one drive on each of two ways.
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
    Box box;                      // contains the points of its track (encounter.hpp)
    Number next = kNone;          // on the same segment
    std::uint32_t pairs = kNone;  // the first one in which it is the later way
  };
  struct Pair {
    Number earlier = kNone, later = kNone;
    std::uint32_t next = kNone;  // with the same later way
    std::uint64_t times = 1;
  };
  struct Drive {
    SimTime until;  // it can be met
    Number way = kNone;
    std::uint32_t next = kNone;  // of the same AGV, or the next free place
  };
  // The drives of one AGV that can be met, perhaps with some that are too old.
  struct OfAgv {
    std::uint32_t oldest = kNone, newest = kNone;
    std::uint32_t count = 0, forgotten = 0;  // the latter since their box was made
    Box box;
  };
  class Judge;
  bool is_of_map(const Way& way) const { return way.segment.index() < map_.segment_count(); }
  // The station at which the way ends. Requires: its segment is one of the map.
  StationId end_of(const Way& way) const;
  void forget_before(SimTime t, OfAgv& agv);
  void remember(const Piece& drive, Number way);
  Drive* newest_of(EntityId agv);

  const LogicalMap& map_;
  double margin_m_;
  std::vector<Number> first_;  // by segment, and last of those without a segment of the map
  std::vector<Way> ways_;
  std::vector<Pair> pairs_;
  double widest_m_ = 0.0, longest_m_ = 0.0;  // of the bodies that have driven
  std::vector<OfAgv> agvs_;
  BroadPhase boxes_;            // of the drives of each AGV
  std::vector<Drive> drives_;   // by place
  std::uint32_t free_ = kNone;  // a place
};

}  // namespace fleetproof
