#pragma once

namespace fleetproof::agents {

// The agent's own parameters: words `key=value`, separated by blanks. Unknown words are ignored.
struct Settings {
  double position_error_m = 0.05;  // the largest error of a perceived position, in x and in y
  double position_late_s = 1.0;    // the largest age of a perceived position
  double charge_below = 0.3;       // the battery level at which the AGV drives to a charger
  double charge_to = 0.9;          // the battery level at which the AGV leaves the charger
  double zones_from = 16.0;        // an AGV of a fleet of so many AGVs only talks to those in its zones
};

// Throws std::invalid_argument with a sentence if a value is not a number or not possible.
Settings read_settings(const char* config);

}  // namespace fleetproof::agents
