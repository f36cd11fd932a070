// The parts of which hulls consist, and which of them are near each other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/facts.hpp"
#include "core/agents/lock_options.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/sectors.hpp"
#include "core/agents/shapes.hpp"

namespace fleetproof::agents {

// An upright rectangle.
struct Box {
  Vec low_m, high_m;

  static Box around(const Shape& shape);
  void extend(const Box& other) {
    low_m = {std::min(low_m.x, other.low_m.x), std::min(low_m.y, other.low_m.y)};
    high_m = {std::max(high_m.x, other.high_m.x), std::max(high_m.y, other.high_m.y)};
  }
  bool comes_within(double distance_m, const Box& other) const {
    return low_m.x - distance_m <= other.high_m.x && other.low_m.x - distance_m <= high_m.x &&
           low_m.y - distance_m <= other.high_m.y && other.low_m.y - distance_m <= high_m.y;
  }
};

// Which parts of hulls come near each other: a square grid over their boxes, whose cells list the parts that come
// within half a distance of them.
class PartsNear {
 public:
  // `boxes` by part.
  PartsNear(std::vector<Box> boxes, double distance_m);
  // From the bytes of another one; they outlive it.
  explicit PartsNear(std::span<const std::byte> bytes);
  PartsNear(const PartsNear&) = delete;
  PartsNear& operator=(const PartsNear&) = delete;

  std::vector<std::byte> bytes() const;
  const Box& box(std::uint32_t part) const { return boxes_[part]; }
  // All parts whose boxes come within the distance of that of this part, and the part itself, by ascending number.
  std::vector<std::uint32_t> around(std::uint32_t part) const;

 private:
  struct Grid {
    Vec low_m;
    double cell_m = 4.0, distance_m = 0.0;
    std::uint32_t columns = 1, rows = 1;
  };
  struct Cells {
    std::uint32_t first_column, last_column, first_row, last_row;
  };

  void choose_cells();
  Cells cells_of(const Box& box) const;
  std::uint32_t index_of(double offset_m, std::uint32_t count) const;
  // Calls `f(cell)` for each cell that lists the part.
  template <class F>
  void for_cells_of(std::uint32_t part, F f) const;

  Grid grid_;
  std::vector<Box> own_boxes_;
  std::vector<std::uint32_t> own_begin_, own_parts_;
  std::span<const Box> boxes_;
  std::span<const std::uint32_t> begin_, parts_;  // parts_ by cell
};

// Hulls keep this distance in addition to the safety distance. It covers rounding in messages, turns that are too small
// to count, and arcs that are not quite the track, of bodies that reach 4.5 m from their reference points.
inline constexpr double kHullTolerance_m = 0.02;
// By this angle a body may point elsewhere than the arcs say (the map gives arcs to 2e-3 rad). Two bodies that reach
// further need more distance.
inline constexpr double kArcHeading_rad = 2.2e-3;

// What hulls depend on, besides map and fleet. It is a part of every question about them.
struct HullKey {
  static constexpr std::uint32_t kNobody = 0xfffff;

  HullOptions options{};
  std::uint32_t self = kNobody;  // whose body every AGV has, if sizes do not differ

  HullKey(const HullOptions& of, std::uint32_t agv) : options(of), self(of.sizes_differ ? kNobody : agv) {}
  explicit HullKey(std::uint64_t question);
  // `item`: below 2^32.
  std::uint64_t question(std::uint64_t item) const;
  static std::uint32_t item_of(std::uint64_t question) { return static_cast<std::uint32_t>(question); }
};

// Of a body that turns, what its hull has room for.
Body turning_body(const Body& kind, const HullOptions& options);

struct HullPart {
  std::uint32_t first = 0, count = 0;  // of its shapes
  Vec centre_m;                        // of a disc that contains its floor
  double reach_m = 0.0;
};

// The floor that each part of a hull covers, for every kind of body in the fleet: first the sweep of each lane, then at
// each station the disc of turning by any angle. Which sectors there are stands here, too; their floor is worked out
// when it is asked for, because that happens to few of them. Requires: the facts outlive the object.
class HullTables {
 public:
  HullTables(const fp_facts& facts, const HullKey& key);

  double clearance_m() const { return clearance_m_; }
  std::uint32_t kind_count() const { return static_cast<std::uint32_t>(kinds_.size()); }
  std::uint32_t kind_of(std::uint32_t agv) const { return kind_of_[agv]; }
  const Body& body(std::uint32_t kind) const { return kinds_[kind]; }
  const Sectors& sectors() const { return sectors_; }
  const HullPart& part(std::uint32_t number) const { return parts_[number]; }
  std::span<const Shape> shapes(std::uint32_t number) const {
    return shapes_.subspan(parts_[number].first, parts_[number].count);
  }
  const PartsNear& near() const { return near_; }

 private:
  explicit HullTables(TableReader tables);

  double clearance_m_;
  std::span<const Body> kinds_;             // different footprints
  std::span<const std::uint32_t> kind_of_;  // by AGV
  Sectors sectors_;
  std::span<const HullPart> parts_;
  std::span<const Shape> shapes_;
  PartsNear near_;
};

}  // namespace fleetproof::agents
