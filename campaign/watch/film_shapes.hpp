#pragma once

#include <string>
#include <vector>

#include "campaign/watch/film_clearances.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// What in the shapes of two bodies broke the safety distance: the sweep of a turn on the spot, the corners in it, a
// bend, a load, the size of one of them, lanes that come near without a common station, half of a margin. Each is a
// sentence that holds for the motions of this run: with that one thing otherwise, and all else as it was, the two keep
// the distance. Distances are cut to centimetres, of clearances every millisecond. Empty: no such thing is decisive.
std::vector<std::string> shape_sentences(const Scenario& scenario, const PiecesOfBodies& bodies,
                                         const Violation& violation, SimTime end);

}  // namespace fleetproof
