#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>

#include "campaign/workers/cause_of_death.hpp"

namespace fleetproof {

// R, S, T, Z, ... as /proc tells it; X: there is no such process.
char process_state(pid_t process);

// Watches a worker from outside while it has a run under way. CPU time decides: a worker that gets no CPU is not slow.
// Only a worker that sleeps, waits or is stopped is measured by the clock on the wall.
class WorkerWatch {
 public:
  // CPU time, and sleep in a row.
  struct Limits {
    double run_s = 0.0;
    double call_s = std::numeric_limits<double>::infinity();  // of one call into an agent
  };
  // `call`: the number of the call into an agent that is under way.
  WorkerWatch(pid_t worker, Limits limits, const std::atomic<std::uint64_t>& call);

  // Call this about every `period_s`. Empty: the worker may go on.
  std::optional<WorkerState> look(double period_s);

 private:
  std::optional<double> cpu_s() const;  // of the worker so far; empty: it is dead

  pid_t worker_;
  Limits limits_;
  const std::atomic<std::uint64_t>& call_;
  std::uint64_t last_call_;
  double begin_s_, call_begin_s_, last_s_;
  double asleep_s_ = 0.0;
};

}  // namespace fleetproof
