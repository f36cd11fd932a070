#pragma once

#include <string>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The text of a scenario file. It is canonical: fields in fixed order, exact, without those that are left out at their
// default. If `parse_scenario` (scenario_file.hpp) reads the text, `to_text` gives the same text again, on every
// machine.
std::string to_text(const Scenario& scenario);
// The same without the layout. `parse_scenario_on` reads it.
std::string text_without_layout(const Scenario& scenario);

}  // namespace fleetproof
