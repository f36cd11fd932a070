#pragma once

#include <cstdint>
#include <string>

#include "core/layout.hpp"
#include "core/random.hpp"

namespace fleetproof {

// A point in whole millimetres: generated layouts have short decimals and the same bits everywhere.
struct PointMm {
  std::int64_t x = 0, y = 0;
};

// low, low + step, ..., high with equal chances.
std::int64_t draw_between(Draws& draws, std::int64_t low, std::int64_t high, std::int64_t step);

enum class Way : std::uint8_t { Both, Forward, Backward };

// Puts a generated layout together. Segments are named after their stations: "A1.0-A1.1".
class LayoutBuilder {
 public:
  explicit LayoutBuilder(std::string name) { layout_.name = std::move(name); }

  StationId station(std::string name, PointMm at, Purposes purposes = Purpose::Routing);
  void straight(StationId from, StationId to, Way way = Way::Both);
  // A curve that leaves both ends along the x axis.
  void s_bend(StationId from, StationId to, Way way = Way::Both);
  PointMm position(StationId station) const { return positions_[station.index()]; }

  // The layout, its floor reaching 3 m beyond the outermost stations.
  Layout take();

 private:
  void segment(StationId from, StationId to, Way way, bool bend);

  Layout layout_;
  std::vector<PointMm> positions_;
};

}  // namespace fleetproof
