#pragma once

#include <string>

#include "core/scenario/layout.hpp"

namespace fleetproof::test {

// A one-way ring of six stations with spurs: a source that AGVs leave with a load alone, a sink that they leave without
// one, a charger for empty AGVs, and a shelf for all.
inline Layout source_and_sink() {
  Layout layout;
  layout.name = "source and sink";
  layout.floor_low_m = {-10.0, -10.0};
  layout.floor_high_m = {26.0, 18.0};
  const Vec2 ring[] = {{0.0, 0.0}, {8.0, 0.0}, {16.0, 0.0}, {16.0, 8.0}, {8.0, 8.0}, {0.0, 8.0}};
  const auto join = [&](std::uint32_t from, std::uint32_t to, LoadState load) {
    layout.segments.push_back(
        {layout.stations[from].name + "-" + layout.stations[to].name, StationId{from}, StationId{to}, false});
    if (load != LoadState::Any) layout.segments.back().permissions = {{"", load}};
  };
  for (std::uint32_t i = 0; i < 6; ++i) layout.stations.push_back({"r" + std::to_string(i), ring[i], Purpose::Routing});
  for (std::uint32_t i = 0; i < 6; ++i) join(i, (i + 1) % 6, LoadState::Any);
  const auto spur = [&](const char* name, std::uint32_t at, Vec2 position_m, Purpose purpose, LoadState in,
                        LoadState out) {
    const auto end = static_cast<std::uint32_t>(layout.stations.size());
    layout.stations.push_back({name, position_m, purpose});
    join(at, end, in);
    join(end, at, out);
  };
  spur("source", 1, {8.0, -6.0}, Purpose::Storage, LoadState::Empty, LoadState::Loaded);
  spur("sink", 4, {8.0, 14.0}, Purpose::Storage, LoadState::Loaded, LoadState::Empty);
  spur("charger", 0, {-6.0, 0.0}, Purpose::Charging, LoadState::Empty, LoadState::Empty);
  spur("shelf", 3, {22.0, 8.0}, Purpose::Storage, LoadState::Any, LoadState::Any);
  return layout;
}

}  // namespace fleetproof::test
