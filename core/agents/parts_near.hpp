#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

}  // namespace fleetproof::agents
