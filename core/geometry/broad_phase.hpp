#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/box_grid.hpp"
#include "core/geometry/rectangle.hpp"

namespace fleetproof {

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
