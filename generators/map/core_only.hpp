#pragma once

#include <string>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/map/strong_components.hpp"

namespace fleetproof {

// Which stations can all reach each other. On a layout with rules, only the core is told from the others.
StrongComponents parts_of(const Layout& layout);

// Keeps the largest part, with the segments between its stations. Their order stays. Requires: parts_of(layout), or the
// parts that remain if some segments are not counted.
void keep_largest(Layout& layout, const StrongComponents& parts);

// The same. Returns the names of the stations that were cut off.
std::vector<std::string> keep_core(Layout& layout);

// "all 59 stations can reach each other", or how many can, and the names of the others.
std::string reachability_text(const Layout& layout);

// Sentences about stations of the core that rules keep from a part of their purposes: where an AGV with all permissions
// can only pick, or only drop, or cannot stop to charge or park.
std::vector<std::string> limited_uses(const Layout& layout);

// "11 storage, 4 charging, 5 parking": how many stations have each purpose.
std::string purposes_summary(const Layout& layout);

}  // namespace fleetproof
