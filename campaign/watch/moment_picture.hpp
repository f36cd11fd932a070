#pragma once

#include <string>

#include "campaign/watch/moment.hpp"

namespace fleetproof {

// The floor at one instant as SVG, as the paper draws it (Figs. 2, 3, 4 and 6 to 10): the map with axes in metres, all
// bodies with their safety perimeters, the hulls of activities in progress and their activity perimeters. Words below
// it say which activities conflict and who is too close. The same run and instant give the same bytes.
std::string moment_svg(const Moment& moment, const Scenario& scenario);

}  // namespace fleetproof
