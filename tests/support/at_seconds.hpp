#pragma once

#include "core/base/sim_time.hpp"

namespace fleetproof {

// So many seconds after the start of the run.
inline SimTime at_seconds(double value_s) { return kStart + seconds(value_s); }

}  // namespace fleetproof
