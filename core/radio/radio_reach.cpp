#include "core/radio/radio_reach.hpp"

#include <algorithm>
#include <cmath>

namespace fleetproof {
namespace {

constexpr double kSmallestCell_m = 12.0;  // for drives of one segment
constexpr double kMostCells = 32.0;       // in a row
// The length of a curve is known to a small part of it, and places are rounded.
constexpr double kReachSlack_m = 0.05, kSlackOfWay = 0.01;

std::size_t cells_along(double floor_m, double side_m) {
  return 1 + static_cast<std::size_t>(std::clamp(floor_m / side_m, 0.0, kMostCells));
}

}  // namespace

RadioReach::RadioReach(std::size_t agvs, std::size_t askers, double range_m, const Box& floor)
    : range_m_(range_m), corner_m_(floor.low_m), circles_(agvs), answers_(askers) {
  const Vec2 size_m = floor.high_m - floor.low_m;
  side_m_ = std::max({range_m, size_m.maxCoeff() / kMostCells, kSmallestCell_m});
  columns_ = cells_along(size_m.x(), side_m_);
  rows_ = cells_along(size_m.y(), side_m_);
  cells_.resize(columns_ * rows_ + 1);
  for (std::uint32_t agv = 0; agv < agvs; ++agv) cells_.back().push_back(agv);
  filed_in_.assign(agvs, cells_.size() - 1);
  changes_.assign(cells_.size(), 1);
}

// A point of a way is not farther from the middle between its ends than half the length of the way.
RadioReach::Circle RadioReach::circle_of(const Piece& piece) {
  const Vec2 begin_m = piece.pose_at(piece.begin).position_m;
  if (piece.manner != Manner::Drive) return {begin_m, 0.0};
  const Vec2 end_m = piece.pose_at(piece.end).position_m;
  return {0.5 * (begin_m + end_m), (0.5 + kSlackOfWay) * piece.profile.distance() + kReachSlack_m};
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
  ++changes_anywhere_;
  ++changes_[in];
  if (in == cell) return;
  ++changes_[cell];
  std::erase(cells_[in], agv);
  cells_[cell].push_back(agv);
  in = cell;
}

RadioReach::Near RadioReach::near(AgvId asker, const Vec2& place_m) {
  Answer& answer = answers_[asker.index()];
  const bool is_of_here = answer.changes != 0 && answer.place_m == place_m;
  if (is_of_here && answer.changes == changes_anywhere_) return answer.near();
  if (!is_of_here) answer.block = block_around(place_m);
  const std::uint64_t changes_there = changes_in(answer.block);
  answer.changes = changes_anywhere_;
  if (is_of_here && answer.changes_there == changes_there) return answer.near();
  answer.place_m = place_m;
  answer.changes_there = changes_there;
  find(asker, answer);
  return answer.near();
}

RadioReach::Block RadioReach::block_around(const Vec2& place_m) const {
  const double around_m = range_m_ + 0.5 * side_m_;
  return {.left = column(place_m.x() - around_m),
          .right = column(place_m.x() + around_m),
          .low = row(place_m.y() - around_m),
          .high = row(place_m.y() + around_m)};
}

// It grows with every change there. That of AGVs that may be anywhere belongs to every block.
std::uint64_t RadioReach::changes_in(const Block& block) const {
  std::uint64_t sum = changes_.back();
  for (std::size_t y = block.low; y <= block.high; ++y) {
    for (std::size_t x = block.left; x <= block.right; ++x) sum += changes_[y * columns_ + x];
  }
  return sum;
}

void RadioReach::find(AgvId asker, Answer& answer) const {
  const Block& block = answer.block;
  answer.agvs = cells_.back();
  std::erase(answer.agvs, asker.value);
  answer.is_exact = answer.agvs.empty();
  for (std::size_t y = block.low; y <= block.high; ++y) {
    for (std::size_t x = block.left; x <= block.right; ++x) {
      for (const std::uint32_t agv : cells_[y * columns_ + x]) {
        const auto& [centre_m, radius_m] = circles_[agv];
        if (agv == asker.value || (centre_m - answer.place_m).norm() > range_m_ + radius_m) continue;
        answer.agvs.push_back(agv);
        answer.is_exact = answer.is_exact && radius_m == 0.0;
      }
    }
  }
  std::ranges::sort(answer.agvs);
  answer.agvs.resize(answer.agvs.size() + kMoreToRead);
}

std::size_t RadioReach::cell(double from_m, double side_m, std::size_t count) {
  const double number = from_m / side_m;
  if (!(number > 0.0)) return 0;
  return number < static_cast<double>(count) ? static_cast<std::size_t>(number) : count - 1;
}

}  // namespace fleetproof
