#pragma once

#include <vector>

#include "reports/markup/markup.hpp"
#include "reports/replay_page/drive_reasons.hpp"

namespace fleetproof::web {

// The reasons of what is fatal, side by side; the others stand in the data of the page.
html::Element reasons_part(const std::vector<Reason>& reasons);

}  // namespace fleetproof::web
