#pragma once

#include <string>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// The layout as LIF 1.0. The format has no words for the purposes of a station, so they stand in the description of its
// node, where parse_lif finds them. If the text is read, the layout is the same, but for what lost_in_lif() says, and
// with two exceptions. Two one-way segments on one track become one segment (merge_antiparallel). The floor is fitted
// again. A layout without segments cannot be read again.
std::string to_lif(const Layout& layout);

// One sentence for each kind of thing that the layout has and LIF has no place for.
std::vector<std::string> lost_in_lif(const Layout& layout);

}  // namespace fleetproof
