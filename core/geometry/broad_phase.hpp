#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/rectangle.hpp"

namespace fleetproof {

// Finds the bodies whose boxes overlap a given box. Boxes may be placed and removed at any time. Up to kScanned bodies
// are scanned. Above that, each box is filed by its middle in a loose grid: in one cell that is at least as large as
// the box. A question then looks half a cell beyond its own box. Both methods give the same answers.
class BroadPhase {
 public:
  static constexpr std::size_t kScanned = 64;

  explicit BroadPhase(std::size_t bodies, std::size_t scanned = kScanned);

  // A body has one box at a time, or none.
  void place(std::size_t body, const Box& box) {
    if (files()) return file(body, box);
    Two& two = twos_[body / 2];
    two.left[body % 2] = box.low_m.x(), two.bottom[body % 2] = box.low_m.y();
    two.right[body % 2] = box.high_m.x(), two.top[body % 2] = box.high_m.y();
  }
  void remove(std::size_t body) {
    if (files()) return take_out(body);
    twos_[body / 2].left[body % 2] = Box{}.low_m.x();  // it overlaps no box
    twos_[body / 2].right[body % 2] = Box{}.high_m.x();
  }
  // Requires: the body has one.
  Box box_of(std::size_t body) const {
    if (files()) return boxes_[body];
    const Two& two = twos_[body / 2];
    return {{two.left[body % 2], two.bottom[body % 2]}, {two.right[body % 2], two.top[body % 2]}};
  }

  // In ascending order; valid until the next question.
  std::span<const std::uint32_t> overlapping(const Box& box) {
    files() ? find_filed(box) : scan(box);
    return std::span(found_).first(count_);
  }

 private:
  // The boxes of two bodies.
  struct Two {
    std::array<double, 2> left{Box{}.low_m.x(), Box{}.low_m.x()}, bottom{}, right{Box{}.high_m.x(), Box{}.high_m.x()},
        top{};
  };
  // Where a body is filed: in the chain of the bodies whose cells share a bucket, at one size of cells.
  struct Link {
    std::uint32_t before, after, chain, level;
  };
  static constexpr std::uint32_t kLevels = 3;
  static constexpr std::uint32_t kNobody = ~std::uint32_t{0};

  class Question;
  void scan(const Box& box);
  void find_filed(const Box& box);
  void scan_filed(const Box& box);
  void file(std::size_t body, const Box& box);
  void take_out(std::size_t body);
  void link(std::uint32_t body, std::size_t chain, std::uint32_t level);
  void unlink(std::uint32_t body);
  bool look_around(std::uint32_t level, const Box& box);
  void look_into(std::size_t chain, const Box& box);
  std::size_t chain_of(const Box& box, std::uint32_t level) const;
  std::size_t chain_of(std::uint32_t level, std::int64_t x, std::int64_t y) const;
  bool files() const { return !heads_.empty(); }
  bool is_placed(std::size_t body) const { return boxes_[body].low_m.x() <= boxes_[body].high_m.x(); }

  std::vector<Two> twos_;             // if bodies are scanned
  std::vector<Box> boxes_;            // if they are filed, like the rest
  std::vector<std::uint32_t> heads_;  // of the chains; the last chain holds the bodies that are too large for any cell.
                                      // Empty if bodies are scanned
  std::vector<Link> links_;           // by body
  std::array<std::size_t, kLevels + 1> filed_{};  // bodies by level
  std::array<double, kLevels + 1> widest_m_{};    // by level: half of the widest box so far, from its middle to its rim
  std::vector<std::uint32_t> found_;              // the first count_
  std::size_t count_ = 0;
};

}  // namespace fleetproof
