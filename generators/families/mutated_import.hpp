#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/map/rejection_counts.hpp"

namespace fleetproof {

inline constexpr std::string_view kMutatedImport = "mutated-import";

// A layout much like `base`, a real one: up to 10 % of its segments left out, up to 10 % of the one-way ones turned
// round (in one draw of four all the others are instead), every station moved by up to 0.3 m with its curves, all of it
// scaled by 0.8-1.2; then the largest part whose stations can all reach each other. Nothing if the draw is no sound
// layout (problems_of()) or keeps less than half of the stations: then the reason is counted, and how much of the draws
// is used is not said. `base` is sound.
std::shared_ptr<const LogicalMap> draw_mutated_map(const Layout& base, Draws& draws, RejectionCounts& counts);
std::optional<Layout> draw_mutation(const Layout& base, Draws& draws, RejectionCounts& counts);

}  // namespace fleetproof
