#pragma once

#include <string>
#include <vector>

#include "campaign/cli/moment.hpp"

namespace fleetproof::cli {

// At most 20 characters, printable.
std::string moment_name(const Scenario& scenario, EntityId id);
// "A drives from 10 to 9, 2.00 s to 10.00 s".
std::string activity_text(const Scenario& scenario, const Piece& piece);

// Lines below a picture: the activities in progress, then which of them conflict. None is longer than the picture is
// wide, and there are at most 20 of them.
std::vector<std::string> moment_lines(const Moment& moment, const Scenario& scenario);

}  // namespace fleetproof::cli
