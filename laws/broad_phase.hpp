#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/rectangle.hpp"

namespace fleetproof {

// Which bodies' boxes overlap a given one, as boxes come and go. A fleet of up to kScanned bodies is scanned; above, boxes are filed in the cells of
// a uniform grid that they touch, and a question looks into the cells that it touches. Answers do not depend on which of the two it is.
class BroadPhase {
 public:
  static constexpr std::size_t kScanned = 32;

  explicit BroadPhase(std::size_t bodies, std::size_t scanned = kScanned);

  // A body has one box at a time, or none.
  void place(std::size_t body, const Box& box);
  void remove(std::size_t body);
  const Box& box_of(std::size_t body) const { return boxes_[body]; }

  // Ascending; good until the next question.
  std::span<const std::uint32_t> overlapping(const Box& box);

 private:
  struct Cells {
    std::int64_t left, bottom, right, top;
    std::int64_t count() const { return (right - left + 1) * (top - bottom + 1); }
  };
  static Cells cells_of(const Box& box);
  std::vector<std::uint32_t>& bucket(std::int64_t x, std::int64_t y);
  template <class Visit>
  void for_each_bucket(const Cells& cells, Visit visit);
  std::span<const std::uint32_t> scanned(const Box& box);
  void offer(std::uint32_t body, const Box& box);

  std::vector<Box> boxes_;
  std::vector<std::vector<std::uint32_t>> buckets_;  // of cells, by hash; none if bodies are scanned
  std::vector<std::uint32_t> wide_;                  // bodies whose boxes touch so many cells that no cell lists them
  std::vector<std::uint64_t> asked_;                 // by body: the last question that met it
  std::uint64_t question_ = 0;
  std::vector<std::uint32_t> found_;
};

}  // namespace fleetproof
