#pragma once

#include <string>
#include <vector>

#include "campaign/watch/moment.hpp"

namespace fleetproof {

// Printable; at most 20 characters, and "..." if there are more.
std::string moment_name(const Scenario& scenario, EntityId id);
// "A drives from 10 to 9, 2.00 s to 10.00 s".
std::string activity_text(const Scenario& scenario, const Piece& piece);

// Lines below a picture: the activities in progress, as many on a line as fit, then which of them conflict. There are
// at most 20 lines.
std::vector<std::string> moment_lines(const Moment& moment, const Scenario& scenario);

}  // namespace fleetproof
