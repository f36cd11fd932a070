// Progress: deadlock, livelock and starvation.
#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Accuses a fleet or an AGV that has open transports and makes no progress. The law looks at the run every stuck_after
// / 12, but not more often than once a second. The beginning of an incident is exact to the nanosecond, its end to one
// look.
//
// - Deadlock: AGVs with open transports have begun and ended no action for stuck_after, and wait for each other in a
//   circle; or all AGVs with open transports have stood for so long, with or without a circle. The law also files which
//   AGV waits for which: as the AGV declares, or else inferred from the body that stands in the next lane of a shortest
//   way to its goal.
// - Livelock: AGVs move, but for twice stuck_after no load has been picked or delivered, and no charge has ended.
//   Long ways give the fleet more time: twice what the way takes at top speed by which an AGV has come nearer to its
//   goal meanwhile. The goal is that of its load, or of its oldest open transport.
// - Starvation: one AGV has picked or delivered nothing for twice stuck_after, while the other AGVs have finished two
//   transports each, on average.
// - An order that is not taken: no AGV has taken up the load of an open transport for twice stuck_after, while the
//   fleet has finished later ones, two for each AGV on average.
//
// The transports of an AGV are those that the scenario gives it, the open one whose load it carries, and the open one
// on which it works, as is declared. If open transports wait and nothing is declared, only the fleet as a whole can
// stand still: then a deadlock without an AGV is filed. While open transports wait, every AGV that moves may be at work
// on one.
//
// The law does not see why an AGV waits, nor a circle that only passes through AGVs that still move.
std::unique_ptr<Law> make_progress_law(const Scenario& scenario);

}  // namespace fleetproof
