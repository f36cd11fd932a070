#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario/layout.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// How many external sources a world has, and what they are alike in; their places are drawn.
struct DrawnSources {
  std::uint32_t count = 0;
  RadioSource like;  // its place means nothing
};

// Sources anywhere on the layout's floor, uniformly. The place of each hangs on the seed and its number: one more
// leaves the others where they were, and nothing else is drawn from this stream. `seed` is the world's, or that of a
// held stream `radio`.
std::vector<RadioSource> draw_radio_sources(const DrawnSources& drawn, const Layout& layout, std::uint64_t seed);

}  // namespace fleetproof
