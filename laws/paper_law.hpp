#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// The collision detection law of Fig. 5 as published, but for the loop index of line 28 (`j`, where it prints `i`). It
// exists to reproduce the paper's figures (4 020 checks on Fig. 4 at 400 snapshots a second) and to show what the
// published rule misses; it is no judge.
//
// For each drive activity and each other entity: if that entity is in no drive activity during the interval, one check
// of the activity perimeter against its body; else, for each of its drive activities in that time, one check of the two
// activity perimeters and, if they overlap, one check per snapshot of the common interval, without its end. An activity
// perimeter is the axis-aligned box of all that the AGV covers, widened by the threshold. Turning on the spot is no
// drive activity.
//
// An entity that stands in an activity perimeter is accused for the whole activity, as the rule says no more; the
// smallest clearance filed with it is that at the activity's snapshots and end, and tells a false accusation by being
// above the safety distance.
std::unique_ptr<Law> make_paper_law(const Scenario& scenario);

}  // namespace fleetproof
