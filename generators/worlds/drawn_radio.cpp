#include "generators/worlds/drawn_radio.hpp"

#include "core/base/random.hpp"

namespace fleetproof {

namespace {

enum RadioTopic : std::uint32_t { kPlaceTopic = 1, kDelayTopic = 2 };

}  // namespace

bool draws_constant_delay(double share, std::uint64_t seed) {
  if (share == 0.0) return false;
  return Draws(stream_key(seed, Stream::RadioSources), kDelayTopic, 0).uniform() < share;
}

std::vector<RadioSource> draw_radio_sources(const DrawnSources& drawn, const Layout& layout, std::uint64_t seed) {
  const std::uint64_t key = stream_key(seed, Stream::RadioSources);
  std::vector<RadioSource> sources(drawn.count, drawn.like);
  for (std::uint32_t i = 0; i < drawn.count; ++i) {
    Draws draws(key, kPlaceTopic, i);
    sources[i].x_m = draws.uniform(layout.floor_low_m.x(), layout.floor_high_m.x());
    sources[i].y_m = draws.uniform(layout.floor_low_m.y(), layout.floor_high_m.y());
  }
  return sources;
}

}  // namespace fleetproof
