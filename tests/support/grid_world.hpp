#pragma once

#include "core/base/random.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof::test {

// Streets of bidirectional segments, rows x columns stations 8 m apart, with a storage spur of 3.5 m at every second
// station: worlds of any size and one density, for benchmarks.
inline Scenario grid_world(int rows, int columns, std::uint32_t fleet, double horizon_s, std::uint64_t seed) {
  constexpr double kPitch_m = 8.0;
  Layout layout;
  layout.name = "grid";
  const auto at = [&](int r, int c) { return StationId{static_cast<std::uint32_t>(r * columns + c)}; };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      layout.stations.push_back(
          {"s" + std::to_string(r) + "." + std::to_string(c), Vec2{kPitch_m * c, kPitch_m * r}, Purpose::Routing});
    }
  }
  const auto link = [&](StationId a, StationId b, bool both) {
    layout.segments.push_back({"e" + std::to_string(layout.segments.size()), a, b, both, {}});
  };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) link(at(r, c), at(r, c + 1), true);
  }
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c < columns; c += 2) link(at(r, c), at(r + 1, c), true);
  }
  std::vector<StationId> spurs;
  for (int r = 0; r < rows; ++r) {
    for (int c = 1; c < columns; c += 2) {
      const StationId spur{layout.stations.size()};
      layout.stations.push_back({"spur" + std::to_string(spur.value), Vec2{kPitch_m * c, kPitch_m * r + 3.5},
                                 Purposes(Purpose::Storage) | Purpose::Parking});
      link(at(r, c), spur, true);
      spurs.push_back(spur);
    }
  }
  Scenario scenario;
  scenario.name = "grid";
  scenario.map = std::make_shared<const LogicalMap>(layout);
  scenario.horizon = seconds(horizon_s);
  scenario.seed = seed;
  Draws draws(stream_key(seed, Stream::Placement));
  for (std::uint32_t i = 0; i < fleet; ++i) {
    const std::size_t pick = i + draws.below(static_cast<std::uint32_t>(spurs.size() - i));
    std::swap(spurs[i], spurs[pick]);
    AgvSetup agv;
    agv.name = "agv-" + std::to_string(i + 1);
    agv.start = spurs[i];
    agv.heading = -Vec2::UnitY();
    double release_s = draws.uniform(0.0, 10.0);
    while (release_s < horizon_s) {
      const StationId from = spurs[draws.below(static_cast<std::uint32_t>(spurs.size()))];
      const StationId to = spurs[draws.below(static_cast<std::uint32_t>(spurs.size()))];
      if (from != to) agv.transports.push_back({from, to, seconds(release_s)});
      release_s += draws.exponential(60.0);
    }
    scenario.agvs.push_back(std::move(agv));
  }
  return scenario;
}

}  // namespace fleetproof::test
