#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Accuses a radio channel that cannot carry the traffic of the fleet, in windows of one second.
//
// Saturated: the air time of all transmissions of a window is at least half of the window. At one half, a channel
// without listening carries most; above it, more traffic gets less through. Interference: other transmissions destroyed
// at least a tenth of the receptions of a window, and at least five. Consecutive windows are one incident; its value is
// the peak. A second copy of a message is no further reception. Losses to an external source are not congestion: such
// a reception counts as not destroyed by a transmission.
//
// The law counts the whole floor as one channel, including transmissions that are out of range of each other. It does
// not see messages that are late because of a lack of air time, unless a message is lost or the window is full.
std::unique_ptr<Law> make_congestion_law(const Scenario& scenario);

}  // namespace fleetproof
