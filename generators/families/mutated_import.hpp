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
// 1. Up to 10 % of the segments are left out.
// 2. Up to 10 % of the one-way segments are reversed. In one draw of four, all others are reversed instead.
// 3. Every station moves by up to 0.3 m, with its curves, and the whole layout is scaled by 0.8-1.2.
// 4. The largest part is kept whose stations can all reach each other.
// None if the result is not sound (problems_of()) or keeps less than half of the stations. The reason is then counted;
// the number of used draws is not defined. Requires: `base` is sound.
std::shared_ptr<const LogicalMap> draw_mutated_map(const Layout& base, Draws& draws, RejectionCounts& counts);
std::optional<Layout> draw_mutation(const Layout& base, Draws& draws, RejectionCounts& counts);

}  // namespace fleetproof
