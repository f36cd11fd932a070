#include "core/agents/lanes_near.hpp"

#include <algorithm>
#include <cmath>

namespace fleetproof::agents {
namespace {

constexpr double kRounding_m = 1e-3;  // of arcs and stations in the map

}  // namespace

LanesNear::LanesNear(const MapView& map, double margin_m) : map_(map), margin_m_(margin_m + kRounding_m) {
  choose_cells();
  begin_.assign(std::size_t{columns_} * rows_ + 1, 0);
  for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane)
    for_cells_of(lane, [&](std::uint32_t cell) { ++begin_[cell + 1]; });
  for (std::size_t cell = 1; cell < begin_.size(); ++cell) begin_[cell] += begin_[cell - 1];
  lanes_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t lane = 0; lane < map.lane_count(); ++lane)
    for_cells_of(lane, [&](std::uint32_t cell) { lanes_[next[cell]++] = lane; });
}

std::span<const std::uint32_t> LanesNear::around(std::uint32_t station) const {
  const Vec at = map_.position_m(station);
  const std::uint32_t cell = row_of(at.y) * columns_ + column_of(at.x);
  return {lanes_.data() + begin_[cell], lanes_.data() + begin_[cell + 1]};
}

// Not many more cells than stations, however wide the map is.
void LanesNear::choose_cells() {
  if (map_.station_count() == 0) return;
  Vec high_m = low_m_ = map_.position_m(0);
  for (std::uint32_t id = 0; id < map_.station_count(); ++id) {
    const Vec at = map_.position_m(id);
    low_m_ = {std::min(low_m_.x, at.x), std::min(low_m_.y, at.y)};
    high_m = {std::max(high_m.x, at.x), std::max(high_m.y, at.y)};
  }
  const Vec size_m = high_m - low_m_;
  const double most_cells = 4.0 * map_.station_count() + 16.0;
  while ((size_m.x / cell_m_ + 1.0) * (size_m.y / cell_m_ + 1.0) > most_cells) cell_m_ *= 2.0;
  columns_ = static_cast<std::uint32_t>(size_m.x / cell_m_) + 1;
  rows_ = static_cast<std::uint32_t>(size_m.y / cell_m_) + 1;
}

// No point of a curve of this length is further from its chord than this.
LanesNear::Cells LanesNear::cells_near(std::uint32_t lane) const {
  const fp_lane& l = map_.lane(lane);
  const Vec from = map_.position_m(l.from), to = map_.position_m(l.to);
  const Vec chord = to - from;
  const double bulge_m = std::sqrt(std::max(0.0, l.length_m * l.length_m - dot(chord, chord))) / 2.0;
  const double around_m = bulge_m + margin_m_;
  return {column_of(std::min(from.x, to.x) - around_m), column_of(std::max(from.x, to.x) + around_m),
          row_of(std::min(from.y, to.y) - around_m), row_of(std::max(from.y, to.y) + around_m)};
}

std::uint32_t LanesNear::index_of(double offset_m, std::uint32_t count) const {
  return static_cast<std::uint32_t>(std::clamp(std::floor(offset_m / cell_m_), 0.0, count - 1.0));
}

template <class F>
void LanesNear::for_cells_of(std::uint32_t lane, F f) const {
  const Cells cells = cells_near(lane);
  for (std::uint32_t row = cells.first_row; row <= cells.last_row; ++row) {
    for (std::uint32_t column = cells.first_column; column <= cells.last_column; ++column) f(row * columns_ + column);
  }
}

}  // namespace fleetproof::agents
