#pragma once

#include "reports/markup/markup.hpp"
#include "reports/replay_page/film_event_log.hpp"

namespace fleetproof::web {

// The event log as a list. A line that stands for several opens; with scripts, a click on a line goes to its instant.
html::Element event_log_part(const EventLog& event_log);

}  // namespace fleetproof::web
