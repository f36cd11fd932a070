#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/map_view.hpp"

namespace fleetproof::agents {

// Which lanes come near a station: a square grid over the map, whose cells list the lanes that may come within a margin
// of them.
class LanesNear {
 public:
  LanesNear(const MapView& map, double margin_m);

  // All lanes that come within the margin of this station, and some others, by ascending number.
  std::span<const std::uint32_t> around(std::uint32_t station) const;

 private:
  struct Cells {
    std::uint32_t first_column, last_column, first_row, last_row;
  };

  void choose_cells();
  Cells cells_near(std::uint32_t lane) const;
  std::uint32_t column_of(double x_m) const { return index_of(x_m - low_m_.x, columns_); }
  std::uint32_t row_of(double y_m) const { return index_of(y_m - low_m_.y, rows_); }
  std::uint32_t index_of(double offset_m, std::uint32_t count) const;
  // Calls `f(cell)` for each cell in which the lane is listed.
  template <class F>
  void for_cells_of(std::uint32_t lane, F f) const;

  const MapView& map_;
  double margin_m_, cell_m_ = 4.0;
  Vec low_m_;
  std::uint32_t columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> begin_, lanes_;  // lanes_ by cell
};

}  // namespace fleetproof::agents
