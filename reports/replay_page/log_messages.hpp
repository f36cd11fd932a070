#pragma once

#include <vector>

#include "reports/replay_page/film_event_log.hpp"

namespace fleetproof::web {

// The messages to or from the bodies that the page is about, for event_log_of: a line where one is sent, and one more
// where it is received if it was long under way and for one receiver.
std::vector<LogLine> message_lines(const Film& film, std::int64_t from_us, std::int64_t to_us);

}  // namespace fleetproof::web
