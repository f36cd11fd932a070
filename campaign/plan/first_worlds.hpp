#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "campaign/plan/plan.hpp"

namespace fleetproof {

// How many worlds of a layout to draw before a campaign, `most` at most and one at least: large floors take long to
// draw, and chance makes less of a difference there.
std::uint64_t worlds_to_draw(std::uint64_t most, std::size_t stations);

// Draws the first worlds of a plan, up to 16 for each layout and fleet size: what is wrong with all or many of them is
// said before the first run. Throws NoRoom if a layout has no room for its fleet in the first world. Returns a sentence
// for each layout and fleet without room in others of these worlds, for each fleet so large that it may stand still
// (more than one AGV for two stations), and for each plant too small for what its name asks for.
std::vector<std::string> build_first_worlds(const CampaignPlan& plan);

}  // namespace fleetproof
