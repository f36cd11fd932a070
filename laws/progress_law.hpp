#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Accuses a fleet, or an AGV, that has open transports and gets nowhere. Looks at the run every stuck_after / 12; an
// incident begins to the nanosecond and ends to within one look.
//
// Deadlock: AGVs that have open transports, have begun and ended no action for stuck_after, and wait for each other in
// a circle; or all AGVs with open transports have stood so long, circle or not. Filed with it is who waits for whom: by
// what the AGV itself declares or, where it declares nothing, by whose body stands in the next lane of a shortest way
// to its goal (inferred, and said so). Livelock: somebody moves, yet for twice stuck_after no load has been picked or
// delivered. Starvation: one AGV has picked or delivered nothing for twice stuck_after, while the others have finished
// two transports each, on average, in that time.
//
// It does not see why anybody waits, a circle that only passes through AGVs that still move, nor that a very long drive
// is on its way: where drives take longer than twice stuck_after, they are accused.
std::unique_ptr<Law> make_progress_law(const Scenario& scenario);

}  // namespace fleetproof
