#pragma once

#include <sys/types.h>

#include <optional>

#include "campaign/workers/cause_of_death.hpp"

namespace fleetproof {

// R, S, T, Z, ... as /proc tells it; X: there is no such process.
char process_state(pid_t process);

// Watches a worker from outside while it has a run under way. CPU time decides: a worker that gets no CPU is not slow.
// Only a worker that sleeps, waits or is stopped is measured by the clock on the wall.
class WorkerWatch {
 public:
  // The run may use `limit_s` of CPU time, and may sleep for as long in a row.
  WorkerWatch(pid_t worker, double limit_s);

  // Call this about every `period_s`. Empty: the worker may go on.
  std::optional<WorkerState> look(double period_s);

 private:
  std::optional<double> cpu_s() const;  // of the worker so far; empty: it is dead

  pid_t worker_;
  double limit_s_, begin_s_, last_s_;
  double asleep_s_ = 0.0;
};

}  // namespace fleetproof
