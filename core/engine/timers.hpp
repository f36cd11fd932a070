// The clocks and timers of the participants.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"
#include "core/scenario/scenario.hpp"

namespace fleetproof {

// The clock of an AGV's computer, or of a computer. It is ahead of the true time by an offset and drifts. All numbers
// are whole.
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

// The clock and the timers of each participant. A timer goes off when the computer's own clock shows its time.
class Timers {
 public:
  Timers(RunContext& run, AgentHostPort agents);

  std::int64_t now_ns(AgvId agv) const { return agv_states_[agv.index()].clock.shows_ns(run_.now); }
  // Replaces the earlier setting of the timer with this number; `at_ns` below 0 clears it.
  void set(AgvId agv, std::uint32_t number, std::int64_t at_ns);
  // The event. Nothing happens if the timer has been set again since.
  void goes_off(AgvId agv, std::uint32_t number, std::uint64_t stamp);
  void forget(AgvId agv) { agv_states_[agv.index()].timers.clear(); }

 private:
  struct Timer {
    std::uint32_t number = 0;
    std::uint64_t stamp = 0;  // 0: cleared
  };
  struct AgvState {
    AgentClock clock;
    std::vector<Timer> timers;
    std::uint64_t last_stamp = 0;
  };
  static Timer* find(AgvState& agv_state, std::uint32_t number);  // null: there is none
  static Timer* add(AgvState& agv_state, std::uint32_t number);

  RunContext& run_;
  AgentHostPort agents_;
  std::vector<AgvState> agv_states_;  // by participant
};

}  // namespace fleetproof
