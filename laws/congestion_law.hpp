#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// Accuses a radio channel that cannot carry what the fleet asks of it, in windows of one second.
//
// Saturated: the air time of all transmissions sent in a window, each by its size, is half of it or more. Half is where
// a channel without listening carries most; beyond it, more sending gets less through. Interference: a tenth or more of
// the receptions of a window, and five at least, were destroyed by other transmissions, as the trace tells. Windows
// that follow each other are one incident; its value is the peak. What an external source destroys is no congestion: it
// counts as a reception that no transmission destroyed.
//
// It counts the whole floor as one channel: transmissions out of each other's range are added up all the same. It does
// not see messages that come late for want of air time, as long as none is lost and the window is not full.
std::unique_ptr<Law> make_congestion_law(const Scenario& scenario);

}  // namespace fleetproof
