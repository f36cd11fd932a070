#pragma once

#include <vector>

#include "core/engine/agent_clock.hpp"
#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"

namespace fleetproof {

// The clock and the timers of each AGV's computer. A timer goes off when the computer's own clock shows its time.
class Timers {
 public:
  Timers(RunContext& run, AgentHostPort agents);

  std::int64_t now_ns(AgvId agv) const { return slices_[agv.index()].clock.shows_ns(run_.now); }
  // Replaces the earlier setting of the timer with this number; `at_ns` below 0 clears it.
  void set(AgvId agv, std::uint32_t number, std::int64_t at_ns);
  // The event. Nothing happens if the timer has been set again since.
  void goes_off(AgvId agv, std::uint32_t number, std::uint64_t stamp);
  void forget(AgvId agv) { slices_[agv.index()].timers.clear(); }

 private:
  struct Timer {
    std::uint32_t number = 0;
    std::uint64_t stamp = 0;  // 0: cleared
  };
  struct Slice {
    AgentClock clock;
    std::vector<Timer> timers;
    std::uint64_t last_stamp = 0;
  };
  static Timer* find(Slice& slice, std::uint32_t number);  // null: there is none
  static Timer* add(Slice& slice, std::uint32_t number);

  RunContext& run_;
  AgentHostPort agents_;
  std::vector<Slice> slices_;  // by AGV
};

}  // namespace fleetproof
