#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/map/rejection_counts.hpp"

namespace fleetproof {

inline constexpr std::string_view kMutatedImport = "mutated-import";

// A drawn variation of the layout `base`, in this order:
// 1. Each segment is left out with a chance of up to 10 %.
// 2. So is each one-way segment reversed. In one draw of four, all others are reversed instead.
// 3. Every station moves by up to 0.3 m, with its curves, and the whole layout is scaled by 0.8-1.2. Stations lose
//    their headings and bans on turning.
// 4. The largest part is kept whose stations can all reach each other.
// None if the result is not sound (problems_of()) or keeps less than half of the stations. The reason is then counted;
// the number of used draws is not defined. Requires: `base` is sound.
std::shared_ptr<const LogicalMap> draw_mutated_map(const Layout& base, Draws& draws, RejectionCounts& counts);
std::optional<Layout> draw_mutation(const Layout& base, Draws& draws, RejectionCounts& counts);

}  // namespace fleetproof
