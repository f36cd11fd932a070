#include "core/agents/parts_near.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/agents/facts.hpp"

namespace fleetproof::agents {
namespace {

constexpr double kGridRounding_m = 1e-3;

}  // namespace

Box Box::around(const Shape& shape) {
  const Vec along = shape.axis * shape.half_length_m, across = left_of(shape.axis) * shape.half_width_m;
  const Vec half{std::abs(along.x) + std::abs(across.x) + shape.radius_m,
                 std::abs(along.y) + std::abs(across.y) + shape.radius_m};
  return {shape.centre_m - half, shape.centre_m + half};
}

PartsNear::PartsNear(std::vector<Box> boxes, double distance_m) : own_boxes_(std::move(boxes)), boxes_(own_boxes_) {
  grid_.distance_m = distance_m + kGridRounding_m;
  choose_cells();
  own_begin_.assign(std::size_t{grid_.columns} * grid_.rows + 1, 0);
  for (std::uint32_t part = 0; part < boxes_.size(); ++part)
    for_cells_of(part, [&](std::uint32_t cell) { ++own_begin_[cell + 1]; });
  for (std::size_t cell = 1; cell < own_begin_.size(); ++cell) own_begin_[cell] += own_begin_[cell - 1];
  own_parts_.resize(own_begin_.back());
  std::vector<std::uint32_t> next(own_begin_.begin(), own_begin_.end() - 1);
  for (std::uint32_t part = 0; part < boxes_.size(); ++part)
    for_cells_of(part, [&](std::uint32_t cell) { own_parts_[next[cell]++] = part; });
  begin_ = own_begin_;
  parts_ = own_parts_;
}

PartsNear::PartsNear(std::span<const std::byte> bytes) {
  TableReader tables(bytes);
  grid_ = tables.next<Grid>().front();
  boxes_ = tables.next<Box>();
  begin_ = tables.next<std::uint32_t>();
  parts_ = tables.next<std::uint32_t>();
}

std::vector<std::byte> PartsNear::bytes() const {
  TableWriter tables;
  tables.add(std::vector{grid_}), tables.add(own_boxes_), tables.add(own_begin_), tables.add(own_parts_);
  return tables.bytes();
}

std::vector<std::uint32_t> PartsNear::around(std::uint32_t part) const {
  std::vector<std::uint32_t> found;
  for_cells_of(part, [&](std::uint32_t cell) {
    for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
      if (boxes_[parts_[i]].comes_within(grid_.distance_m, boxes_[part])) found.push_back(parts_[i]);
    }
  });
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

// Not many more cells than parts, however wide the map is.
void PartsNear::choose_cells() {
  if (boxes_.empty()) return;
  Box whole = boxes_[0];
  for (const Box& box : boxes_) whole.extend(box);
  grid_.low_m = whole.low_m;
  const Vec size_m = whole.high_m - whole.low_m;
  const double most_cells = static_cast<double>(boxes_.size()) + 16.0;
  while ((size_m.x / grid_.cell_m + 1.0) * (size_m.y / grid_.cell_m + 1.0) > most_cells) grid_.cell_m *= 2.0;
  grid_.columns = static_cast<std::uint32_t>(size_m.x / grid_.cell_m) + 1;
  grid_.rows = static_cast<std::uint32_t>(size_m.y / grid_.cell_m) + 1;
}

PartsNear::Cells PartsNear::cells_of(const Box& box) const {
  const double around_m = grid_.distance_m / 2.0;
  return {index_of(box.low_m.x - around_m - grid_.low_m.x, grid_.columns),
          index_of(box.high_m.x + around_m - grid_.low_m.x, grid_.columns),
          index_of(box.low_m.y - around_m - grid_.low_m.y, grid_.rows),
          index_of(box.high_m.y + around_m - grid_.low_m.y, grid_.rows)};
}

std::uint32_t PartsNear::index_of(double offset_m, std::uint32_t count) const {
  return static_cast<std::uint32_t>(std::clamp(std::floor(offset_m / grid_.cell_m), 0.0, count - 1.0));
}

template <class F>
void PartsNear::for_cells_of(std::uint32_t part, F f) const {
  const Cells cells = cells_of(boxes_[part]);
  for (std::uint32_t row = cells.first_row; row <= cells.last_row; ++row) {
    for (std::uint32_t column = cells.first_column; column <= cells.last_column; ++column)
      f(row * grid_.columns + column);
  }
}

}  // namespace fleetproof::agents
