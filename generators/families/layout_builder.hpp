#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"

namespace fleetproof {

// A point in whole millimetres: generated layouts have short decimals and the same bits everywhere.
struct PointMm {
  std::int64_t x = 0, y = 0;
};

// One of low, low + step, ..., high, with equal probability.
std::int64_t draw_between(Draws& draws, std::int64_t low, std::int64_t high, std::int64_t step);

// `wanted` of the numbers 0 .. count-1 in drawn order; all of them if there are fewer.
std::vector<std::uint32_t> draw_some(Draws& draws, std::size_t count, std::size_t wanted);

enum class Way : std::uint8_t { Both, Forward, Backward };

// Builds a generated layout. A segment has the names of its stations: "A1.0-A1.1".
class LayoutBuilder {
 public:
  explicit LayoutBuilder(std::string name) { layout_.name = std::move(name); }

  StationId station(std::string name, PointMm at, Purposes purposes = Purpose::Routing);
  void straight(StationId from, StationId to, Way way = Way::Both);
  // A curve whose tangents at both ends are along the x axis.
  void s_bend(StationId from, StationId to, Way way = Way::Both);
  // The same along the y axis.
  void s_bend_along_y(StationId from, StationId to, Way way = Way::Both);
  // Nearly a quarter circle (the best approximation by one cubic Bezier). It leaves `from` towards `corner` and arrives
  // at `to` from `corner`.
  void quarter_bend(StationId from, PointMm corner, StationId to, Way way = Way::Both);
  // Which end of an AGV goes first on the segment that was added last.
  void travel(Travel there, Travel back);
  std::size_t station_count() const { return positions_.size(); }
  PointMm position(StationId station) const { return positions_[station.index()]; }
  const std::string& name(StationId station) const { return layout_.stations[station.index()].name; }

  // The layout. Its floor extends 3 m beyond the outermost stations.
  Layout take();

 private:
  // The control points are those of the way from `from` to `to`.
  void segment(StationId from, StationId to, Way way, std::vector<PointMm> control_points);

  Layout layout_;
  std::vector<PointMm> positions_;
};

}  // namespace fleetproof
