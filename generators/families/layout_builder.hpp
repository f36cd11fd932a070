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

// low, low + step, ..., high with equal chances.
std::int64_t draw_between(Draws& draws, std::int64_t low, std::int64_t high, std::int64_t step);

// `wanted` of the numbers 0 .. count-1, or all of them if there are fewer, in drawn order.
std::vector<std::uint32_t> draw_some(Draws& draws, std::size_t count, std::size_t wanted);

enum class Way : std::uint8_t { Both, Forward, Backward };

// Puts a generated layout together. Segments are named after their stations: "A1.0-A1.1".
class LayoutBuilder {
 public:
  explicit LayoutBuilder(std::string name) { layout_.name = std::move(name); }

  StationId station(std::string name, PointMm at, Purposes purposes = Purpose::Routing);
  void straight(StationId from, StationId to, Way way = Way::Both);
  // A curve that leaves both ends along the x axis.
  void s_bend(StationId from, StationId to, Way way = Way::Both);
  // A quarter circle, the nearest that one cubic Bezier comes to it, that leaves `from` in the direction of `corner`
  // and comes to `to` from there.
  void quarter_bend(StationId from, PointMm corner, StationId to, Way way = Way::Both);
  PointMm position(StationId station) const { return positions_[station.index()]; }

  // The layout, its floor reaching 3 m beyond the outermost stations.
  Layout take();

 private:
  // Control points are given for the way from `from` to `to`.
  void segment(StationId from, StationId to, Way way, std::vector<PointMm> control_points);

  Layout layout_;
  std::vector<PointMm> positions_;
};

}  // namespace fleetproof
