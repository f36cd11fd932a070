#pragma once

#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The clock of an AGV's computer. It is ahead of the true time by an offset and drifts. All numbers are whole.
class AgentClock {
 public:
  AgentClock() = default;
  explicit AgentClock(const SensingSetup& setup);

  std::int64_t shows_ns(SimTime t) const;
  // The first instant at which the clock shows `ns` or more.
  SimTime when_it_shows(std::int64_t ns) const;

 private:
  std::int64_t offset_ns_ = 0, drift_ppb_ = 0;
};

}  // namespace fleetproof
