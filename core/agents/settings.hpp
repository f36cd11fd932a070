#pragma once

namespace fleetproof::agents {

// What the agent's own parameters say: words `key=value` with blanks between them. Words of others are left alone.
struct Settings {
  double position_error_m = 0.05;  // a perceived position is off by at most so much, in x and in y
  double position_late_s = 1.0;    // and at most so old
  double charge_below = 0.3;       // battery level at which it drives to a charger
  double charge_to = 0.9;          // level with which it leaves one
};

// std::invalid_argument, with a sentence, if a value is no number or makes no sense.
Settings read_settings(const char* config);

}  // namespace fleetproof::agents
