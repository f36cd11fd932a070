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
  static constexpr std::size_t kScanned = 32;

  explicit BroadPhase(std::size_t bodies, std::size_t scanned = kScanned);

  // A body has one box at a time, or none.
  void place(std::size_t body, const Box& box);
  void remove(std::size_t body);
  const Box& box_of(std::size_t body) const { return boxes_[body]; }

  // In ascending order; valid until the next question.
  std::span<const std::uint32_t> overlapping(const Box& box);

 private:
  // The boxes of two bodies, so that one comparison tests both.
  struct Two {
    std::array<double, 2> left, bottom, right, top;
  };
  // Where a body is filed: in the chain of the bodies whose cells share a bucket, at one size of cells.
  struct Link {
    std::uint32_t before, after, chain, level;
  };
  static constexpr std::uint32_t kLevels = 3;
  static constexpr std::uint32_t kNobody = ~std::uint32_t{0};

  void set_scanned(std::size_t body, const Box& box);
  void scan(const Box& box);
  bool look_around(std::uint32_t level, const Box& box);
  void look_into(std::size_t chain, const Box& box);
  std::size_t chain_of(std::uint32_t level, std::int64_t x, std::int64_t y) const;
  bool files() const { return !heads_.empty(); }

  std::vector<Box> boxes_;
  std::vector<Two> twos_;
  std::vector<std::uint32_t> heads_;  // of the chains; the last chain holds the bodies that are too large for any cell.
                                      // Empty if bodies are scanned
  std::vector<Link> links_;           // by body
  std::array<std::size_t, kLevels + 1> filed_{};  // bodies by level
  std::vector<std::uint32_t> found_;              // the first count_
  std::size_t count_ = 0;
};

}  // namespace fleetproof
