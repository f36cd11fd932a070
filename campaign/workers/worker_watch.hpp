#pragma once

#include <sys/types.h>

#include <optional>

#include "campaign/workers/cause_of_death.hpp"

namespace fleetproof {

// Watches a worker from outside while it has a run under way. CPU time decides: a worker that gets no CPU is not slow.
// Only a worker that sleeps is measured by the clock on the wall.
class WorkerWatch {
 public:
  // The run may use `limit_s` of CPU time, and may sleep for as long in a row.
  WorkerWatch(pid_t worker, double limit_s);

  // Call this about every `period_s`. Empty: the worker may go on.
  std::optional<WorkerState> look(double period_s);

 private:
  std::optional<double> cpu_s() const;  // of the worker so far; empty: it is dead
  char state() const;                   // R, S, Z, ... as /proc tells it

  pid_t worker_;
  double limit_s_, begin_s_, last_s_;
  double asleep_s_ = 0.0;
};

}  // namespace fleetproof
