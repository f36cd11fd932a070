#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Accuses nobody: counts what the run met, for a campaign that wants to know whether it tested anything.
//
// Encounters, by kind (encounter.hpp): two drives of two AGVs whose activity perimeters overlap and of which the later
// begins no more than 10 s (20 m of driving) after the end of the earlier; each pair of drives once, by the tracks as
// planned when the later one begins. Near misses: two AGVs, at least one in motion, that come closer than 0.3 m without
// a violation; a pair that stays near for more than 1 s without a gap is one. Faults, by kind, as the trace records
// them.
std::unique_ptr<Law> make_coverage_law(const Scenario& scenario);

}  // namespace fleetproof
