// The judge: every violation of the safety distance, to the nanosecond.
#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// The default law. It uses no snapshots. It follows every pair of bodies over the whole run, whether they drive, turn
// or rest. It dates a violation as exactly as core/clearance does: to a microsecond, on straight lines to 2 ns.
//
// Two pieces of two bodies are settled when the first of them ends. Both trajectories over the common interval are then
// final, so a finding cannot become wrong later. A pair is skipped if its swept boxes are farther apart than the
// threshold and than the smallest clearance so far (at first 0.5 m). Such a pair changes no finding. Pairs of obstacles
// are ignored.
//
// The closest instant of a contact is the touch, filed with the highest speed during the contact and a clearance of 0.
// The law does not measure how deep bodies drive into each other if nothing stops them.
//
// Each uninterrupted episode of a pair is one violation, also across seams between pieces. A rise above the threshold
// ends an episode if it lasts 0.1 s or longer. A shorter rise within one pair of pieces may not be noticed. FCL
// confirms each violation at its closest instant; otherwise `finish` throws InvariantViolation. A perimeter check is
// one distance evaluation; those that describe a violation which is found already do not count.
std::unique_ptr<Law> make_exact_law(const Scenario& scenario);

}  // namespace fleetproof
