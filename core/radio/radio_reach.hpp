#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/motion/piece.hpp"

namespace fleetproof {

// Finds the AGVs that may be in range of a place, without looking at all of them. Each AGV is filed with a circle that
// its reference point does not leave during its piece. The circles stand in a grid over the floor, by their centres.
// Threads: one object serves one run on one thread.
class RadioReach {
 public:
  // `askers`: so many ids ask, AGVs and others. `floor`: what it finds does not depend on it, but how soon.
  RadioReach(std::size_t agvs, std::size_t askers, double range_m, const Box& floor);

  // The AGV has this piece from now on. Call it for every AGV before the first question.
  void piece_begins(const Piece& piece);
  // From now until its next piece the AGV may be anywhere.
  void forget(AgvId agv);

  // Every other AGV whose reference point may be within the range of this place, in ascending order. `is_exact`: they
  // all stand, and are in range. Three more may be read.
  struct Near {
    std::span<const std::uint32_t> agvs;
    bool is_exact;
  };
  // `asker`: who asks; while it asks from the same place and nothing changes around, it gets the same answer.
  Near near(AgvId asker, const Vec2& place_m);

 private:
  static constexpr std::size_t kMoreToRead = 3;
  struct Circle {
    Vec2 centre_m = Vec2::Zero();
    double radius_m = 0.0;  // 0: it stands, or turns on the spot
  };
  static Circle circle_of(const Piece& piece);

  // Cells in columns `left` to `right` and rows `low` to `high`.
  struct Block {
    std::size_t left, right, low, high;
  };
  struct Answer {
    Vec2 place_m = Vec2::Zero();
    Block block{};                                 // around it
    std::uint64_t changes = 0, changes_there = 0;  // anywhere and in the block, when it was found; 0: not found yet
    std::vector<std::uint32_t> agvs;               // and three zeros
    bool is_exact = false;
    Near near() const { return {std::span(agvs).first(agvs.size() - kMoreToRead), is_exact}; }
  };

  // What lies beside the floor belongs to the cells at its rim.
  static std::size_t cell(double from_m, double side_m, std::size_t count);
  std::size_t column(double x_m) const { return cell(x_m - corner_m_.x(), side_m_, columns_); }
  std::size_t row(double y_m) const { return cell(y_m - corner_m_.y(), side_m_, rows_); }
  Block block_around(const Vec2& place_m) const;
  std::uint64_t changes_in(const Block& block) const;
  void find(AgvId asker, Answer& answer) const;
  void file(std::uint32_t agv, std::size_t cell);

  double range_m_, side_m_;
  Vec2 corner_m_;
  std::size_t columns_, rows_;
  std::vector<std::vector<std::uint32_t>> cells_;  // the AGVs by cell; the last one: those that may be anywhere
  std::vector<std::uint64_t> changes_;             // by cell: how often its AGVs or their circles have changed
  std::uint64_t changes_anywhere_ = 1;
  std::vector<Circle> circles_;        // by AGV
  std::vector<std::size_t> filed_in_;  // by AGV: the cell
  std::vector<Answer> answers_;        // by who asked
};

}  // namespace fleetproof
