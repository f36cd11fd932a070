#include "core/radio/radio_reach.hpp"

#include <algorithm>
#include <cmath>

namespace fleetproof {
namespace {

constexpr double kSmallestCell_m = 12.0;  // for drives of one segment
constexpr double kMostCells = 32.0;       // in a row
// The length of a curve is known to a small part of it, and places are rounded.
constexpr double kSlack_m = 0.05, kSlackOfWay = 0.01;

std::size_t cells_along(double floor_m, double side_m) {
  return 1 + static_cast<std::size_t>(std::clamp(floor_m / side_m, 0.0, kMostCells));
}

}  // namespace

RadioReach::RadioReach(std::size_t agvs, double range_m, const Box& floor)
    : range_m_(range_m), corner_m_(floor.low_m), circles_(agvs) {
  const Vec2 size_m = floor.high_m - floor.low_m;
  side_m_ = std::max({range_m, size_m.maxCoeff() / kMostCells, kSmallestCell_m});
  columns_ = cells_along(size_m.x(), side_m_);
  rows_ = cells_along(size_m.y(), side_m_);
  cells_.resize(columns_ * rows_ + 1);
  for (std::uint32_t agv = 0; agv < agvs; ++agv) cells_.back().push_back(agv);
  filed_in_.assign(agvs, cells_.size() - 1);
}

// A point of a way is not farther from the middle between its ends than half the length of the way.
RadioReach::Circle RadioReach::circle_of(const Piece& piece) {
  const Vec2 begin_m = piece.pose_at(piece.begin).position_m;
  if (piece.manner != Manner::Drive) return {begin_m, kSlack_m};
  const Vec2 end_m = piece.pose_at(piece.end).position_m;
  return {0.5 * (begin_m + end_m), (0.5 + kSlackOfWay) * piece.profile.distance() + kSlack_m};
}

void RadioReach::piece_begins(const Piece& piece) {
  const Circle circle = circle_of(piece);
  circles_[piece.entity.index()] = circle;
  const bool has_cell = circle.radius_m <= 0.5 * side_m_;
  file(piece.entity.value,
       has_cell ? row(circle.centre_m.y()) * columns_ + column(circle.centre_m.x()) : cells_.size() - 1);
}

void RadioReach::forget(AgvId agv) { file(agv.value, cells_.size() - 1); }

void RadioReach::file(std::uint32_t agv, std::size_t cell) {
  std::size_t& in = filed_in_[agv];
  if (in == cell) return;
  std::erase(cells_[in], agv);
  cells_[cell].push_back(agv);
  in = cell;
}

}  // namespace fleetproof
