#pragma once

#include <string>

#include "reports/markup/markup.hpp"
#include "reports/replay_page/film.hpp"

namespace fleetproof::web {

// The event logs of a failing run and of one in which one thing is changed, side by side: what both have stands once,
// folded; each difference has a link to the next one. The bodies are those of the failure, by their names.
// `failing_page`: beside this page, which shows the changed run.
html::Element differences_part(const Film& failing, const Film& changed, const std::string& failing_page);

}  // namespace fleetproof::web
