#pragma once

#include <algorithm>

namespace fleetproof::agents {

// The agent's own parameters: words `key=value`, separated by blanks. Unknown words are ignored.
struct Settings {
  double position_error_m = 0.05;  // the largest error of a perceived position, in x and in y
  double position_late_s = 1.0;    // the largest age of a perceived position
  double charge_below = 0.3;       // the battery level at which the AGV drives to a charger
  double charge_to = 0.9;          // the battery level at which the AGV leaves the charger
  double zones_from = 16.0;        // an AGV of a fleet of so many AGVs only talks to those in its zones

  // Battery levels. Urgent: the AGV goes to an occupied charger too, rather than picking another load, and in the end
  // with a load.
  bool is_low(double level) const { return level < charge_below; }
  bool is_urgent(double level, bool loaded) const { return level < (loaded ? 1.0 : 2.0) / 3.0 * charge_below; }
  // Enough to leave the charger to an AGV that asks for it, and not to come back at once.
  bool is_enough(double level) const { return level >= std::min(charge_below + 0.05, charge_to); }
};

// Throws std::invalid_argument with a sentence if a value is not a number or not possible.
Settings read_settings(const char* config);

}  // namespace fleetproof::agents
