#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// The collision detection law of Fig. 5 as published, except for the loop index in line 28 (`j` instead of `i`). It
// reproduces the figures of the paper: 4 020 checks on Fig. 4 at 400 snapshots a second. It also shows what the
// published rule misses. Campaigns do not judge by it.
//
// For each drive activity and each other entity:
// - If the other entity has no drive activity during the interval: one check of the activity perimeter against its
//   body.
// - Otherwise, for each drive activity of the other entity in that time: one check of the two activity perimeters. If
//   they overlap: one check for each snapshot of the common interval, without its end. An activity perimeter is the
//   axis-aligned box of everything that the AGV covers, widened by the threshold. A turn on the spot is not a drive
//   activity.
//
// An entity that stands in an activity perimeter is accused for the whole activity, because the rule does not give a
// shorter time. The filed smallest clearance is the smallest at the snapshots and the end of the activity. If it is
// above the safety distance, the accusation is false.
std::unique_ptr<Law> make_paper_law(const Scenario& scenario);

}  // namespace fleetproof
