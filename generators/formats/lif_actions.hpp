#pragma once

#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/formats/purpose_words.hpp"
#include "generators/text/json_value.hpp"

namespace fleetproof {

// What AGVs of all types do on a node or edge with these rules.
Purposes purposes_of_actions(const std::vector<JsonReader>& rules, const PurposeWords& own);

// Whether a rule forbids to pick or to drop there (forbiddenActionTypes).
bool forbid_transfers(const std::vector<JsonReader>& rules);

}  // namespace fleetproof
