#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Accuses nothing. It counts what the run met, so that a campaign can say whether it tested anything.
//
// - Encounters, by kind (encounter.hpp): two drives of two AGVs whose activity perimeters overlap. The later drive
//   begins at most 10 s (20 m of driving) after the end of the earlier one. Each pair of drives counts once, by the
//   whole tracks of their segments. If an AGV stops on its way for more than 10 s and goes on, this is another drive.
// - Scenes: two such drives side by side (side_by_side.hpp), or to one bottleneck or four-way station
//   (map_places.hpp) by different segments. Counted like encounters; a kind that is not met is left out of the
//   findings.
// - Near misses: two AGVs come closer than 0.3 m without a violation, and at least one of them moves. Times of one pair
//   that are at most 1 s apart count once.
// - Faults, by kind, as the trace records them.
std::unique_ptr<Law> make_coverage_law(const Scenario& scenario);

}  // namespace fleetproof
