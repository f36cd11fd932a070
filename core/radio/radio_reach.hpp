#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/piece.hpp"

namespace fleetproof {

// Finds the AGVs that may be in range of a place, without looking at all of them. Each AGV is filed with a circle that
// its reference point does not leave during its piece. The circles stand in a grid over the floor, by their centres.
// Threads: one object serves one run on one thread.
class RadioReach {
 public:
  // `floor`: what it finds does not depend on it, but how soon.
  RadioReach(std::size_t agvs, double range_m, const Box& floor);

  // The AGV has this piece from now on. Call it for every AGV before the first question.
  void piece_begins(const Piece& piece);
  // From now until its next piece the AGV may be anywhere.
  void forget(AgvId agv);

  // Calls `look(agv)` for every AGV whose reference point may be within the range of this place, in any order.
  template <class Look>
  void for_each_near(const Vec2& place_m, Look look) const {
    for (const std::uint32_t agv : anywhere()) look(AgvId{agv});
    const double around_m = range_m_ + 0.5 * side_m_;
    const std::size_t left = column(place_m.x() - around_m), right = column(place_m.x() + around_m);
    const std::size_t top = row(place_m.y() + around_m);
    for (std::size_t y = row(place_m.y() - around_m); y <= top; ++y) {
      for (std::size_t x = left; x <= right; ++x) {
        for (const std::uint32_t agv : cells_[y * columns_ + x]) {
          const Circle& circle = circles_[agv];
          const double reach_m = range_m_ + circle.radius_m;
          if ((circle.centre_m - place_m).squaredNorm() <= reach_m * reach_m) look(AgvId{agv});
        }
      }
    }
  }

 private:
  struct Circle {
    Vec2 centre_m = Vec2::Zero();
    double radius_m = 0.0;
  };
  static Circle circle_of(const Piece& piece);

  // What lies beside the floor belongs to the cells at its rim.
  static std::size_t cell(double from_m, double side_m, std::size_t count);
  std::size_t column(double x_m) const { return cell(x_m - corner_m_.x(), side_m_, columns_); }
  std::size_t row(double y_m) const { return cell(y_m - corner_m_.y(), side_m_, rows_); }
  const std::vector<std::uint32_t>& anywhere() const { return cells_.back(); }
  void file(std::uint32_t agv, std::size_t cell);

  double range_m_, side_m_;
  Vec2 corner_m_;
  std::size_t columns_, rows_;
  std::vector<std::vector<std::uint32_t>> cells_;  // the AGVs by cell; the last one: those that may be anywhere
  std::vector<Circle> circles_;                    // by AGV
  std::vector<std::size_t> filed_in_;              // likewise: the cell
};

inline std::size_t RadioReach::cell(double from_m, double side_m, std::size_t count) {
  const double number = from_m / side_m;
  if (!(number > 0.0)) return 0;
  return number < static_cast<double>(count) ? static_cast<std::size_t>(number) : count - 1;
}

}  // namespace fleetproof
