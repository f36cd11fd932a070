#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario/layout.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// The number of external sources of a world, and their common properties. Their places are drawn.
struct DrawnSources {
  std::uint32_t count = 0;
  RadioSource like;  // its place is not used
};

// Whether every message of the world of this seed takes the nominal delay, though its campaign has another delay model.
// AGVs that start alike stay alike only if their messages take equally long.
bool draws_constant_delay(double share, std::uint64_t seed);

// Sources at uniform places on the floor of the layout. The place of a source depends on the seed and the number of the
// source, so one more source does not move the others. `seed` is the seed of the world, or the seed of a held stream
// `radio`.
std::vector<RadioSource> draw_radio_sources(const DrawnSources& drawn, const Layout& layout, std::uint64_t seed);

}  // namespace fleetproof
