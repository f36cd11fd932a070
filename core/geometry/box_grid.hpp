#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/rectangle.hpp"

namespace fleetproof {

// Finds the boxes of many bodies that overlap a given one, by a grid over the whole plane. A box is filed in each cell
// that it touches, or in a list of its own if these are many. Two boxes that overlap always touch a common cell.
class BoxGrid {
 public:
  explicit BoxGrid(std::size_t bodies);

  // A body has one box at a time, or none.
  void place(std::size_t body, const Box& box);
  void remove(std::size_t body);
  // Requires: the body has one.
  const Box& box_of(std::size_t body) const { return boxes_[body]; }

  // Replaces `found` by the bodies whose boxes overlap this one, in ascending order.
  void find(const Box& box, std::vector<std::uint32_t>& found) const;

 private:
  static constexpr std::uint32_t kNobody = ~std::uint32_t{0};
  static constexpr std::uint32_t kMostCells = 16;  // of a box in the grid

  // Cells in columns `left` to `right` and rows `bottom` to `top`.
  struct Cells {
    std::int32_t left = 0, right = -1, bottom = 0, top = -1;
    std::int64_t count() const { return (std::int64_t{right} - left + 1) * (std::int64_t{top} - bottom + 1); }
    bool operator==(const Cells&) const = default;
  };
  // Where a body is filed once: in the chain of those whose cells share a bucket.
  struct Link {
    std::uint32_t before, after, chain;
  };
  // By body: its cells, and in how many chains it is filed, which is once in the last one if its cells are too many.
  struct Filed {
    Cells cells;
    std::uint32_t times = 0;
  };
  static Cells cells_of(const Box& box);
  void take_out(std::size_t body);
  void link(std::uint32_t link, std::size_t chain);
  std::size_t chain_of(std::int32_t x, std::int32_t y) const;
  void look_into(std::size_t chain, const Box& box, std::vector<std::uint32_t>& found) const;

  std::vector<Box> boxes_;            // by body
  std::vector<Filed> filed_;          // likewise
  std::vector<Link> links_;           // likewise, kMostCells of each
  std::vector<std::uint32_t> heads_;  // of the chains: links. The last chain is that of bodies with too many cells
};

}  // namespace fleetproof
