// The broad phase: which bodies may come near each other, found by a grid of boxes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
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
  std::vector<Filed> filed_;          // by body
  std::vector<Link> links_;           // by body, kMostCells of each
  std::vector<std::uint32_t> heads_;  // of the chains: links. The last chain is that of bodies with too many cells
};

// Finds the bodies whose boxes overlap a given box. Boxes may be placed and removed at any time. Up to kScanned bodies
// are scanned. Above that, they are filed in a grid. Both methods give the same answers.
class BroadPhase {
 public:
  static constexpr std::size_t kScanned = 64;

  explicit BroadPhase(std::size_t bodies, std::size_t scanned = kScanned);

  // A body has one box at a time, or none.
  void place(std::size_t body, const Box& box) {
    if (grid_) return grid_->place(body, box);
    Two& two = twos_[body / 2];
    two.left[body % 2] = box.low_m.x(), two.bottom[body % 2] = box.low_m.y();
    two.right[body % 2] = box.high_m.x(), two.top[body % 2] = box.high_m.y();
  }
  void remove(std::size_t body) {
    if (grid_) return grid_->remove(body);
    twos_[body / 2].left[body % 2] = Box{}.low_m.x();  // it overlaps no box
    twos_[body / 2].right[body % 2] = Box{}.high_m.x();
  }
  // Requires: the body has one.
  Box box_of(std::size_t body) const {
    if (grid_) return grid_->box_of(body);
    const Two& two = twos_[body / 2];
    return {{two.left[body % 2], two.bottom[body % 2]}, {two.right[body % 2], two.top[body % 2]}};
  }

  // In ascending order; valid until the next question.
  std::span<const std::uint32_t> overlapping(const Box& box) {
    if (grid_) {
      grid_->find(box, found_);
      return found_;
    }
    return std::span(found_).first(scan(box));
  }

 private:
  // The boxes of two bodies.
  struct Two {
    std::array<double, 2> left{Box{}.low_m.x(), Box{}.low_m.x()}, bottom{}, right{Box{}.high_m.x(), Box{}.high_m.x()},
        top{};
  };
  class Question;
  // The first so many of `found_` are the answer.
  std::size_t scan(const Box& box);

  std::vector<Two> twos_;  // if bodies are scanned; their number is rounded up
  std::optional<BoxGrid> grid_;
  std::vector<std::uint32_t> found_;
};

}  // namespace fleetproof
