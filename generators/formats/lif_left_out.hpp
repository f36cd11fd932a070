#pragma once

#include <string>
#include <vector>

#include "generators/formats/purpose_words.hpp"

namespace fleetproof {

class JsonReader;

// Adds one sentence for each kind of thing in a LIF file that the import does not use: how many there are, and the
// names of the first. It knows what the import reads, by key, for LIF 1.0 and the spellings of its successor, and names
// what it does not know. `layout` is the layout that is read; of other layouts nothing is told.
// Actions that `own` names are used.
void note_left_out(const JsonReader& root, const JsonReader& layout, const PurposeWords& own,
                   std::vector<std::string>& warnings);

}  // namespace fleetproof
