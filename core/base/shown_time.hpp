#pragma once

#include "core/base/sim_time.hpp"

namespace fleetproof {

// Seconds since the start as people read them: cut to milliseconds, not rounded. So no digit differs from the full
// number, and an instant reads alike in each text, table and page.
constexpr double shown_seconds(Duration since_start) {
  return static_cast<double>(since_start.count() / 1'000'000) / 1e3;
}
constexpr double shown_seconds(SimTime t) { return shown_seconds(t - kStart); }

}  // namespace fleetproof
