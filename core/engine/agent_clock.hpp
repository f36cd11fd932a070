#pragma once

#include <algorithm>
#include <cstdint>

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The clock of an AGV's computer. It is ahead of the true time by an offset and drifts. All numbers are whole.
class AgentClock {
 public:
  AgentClock() = default;
  explicit AgentClock(const SensingSetup& setup);

  std::int64_t shows_ns(SimTime t) const { return drift_ppb_ == 0 ? to_ns(t) + offset_ns_ : shows_with_drift_ns(t); }
  // The first instant at which the clock shows `ns` or more.
  SimTime when_it_shows(std::int64_t ns) const {
    ns = std::min(ns, kLongestDuration.count());  // an agent may ask for the end of time
    return drift_ppb_ == 0 ? at_ns(std::max<std::int64_t>(0, ns - offset_ns_)) : when_it_shows_with_drift(ns);
  }

 private:
  std::int64_t shows_with_drift_ns(SimTime t) const;
  SimTime when_it_shows_with_drift(std::int64_t ns) const;

  std::int64_t offset_ns_ = 0, drift_ppb_ = 0;
};

}  // namespace fleetproof
