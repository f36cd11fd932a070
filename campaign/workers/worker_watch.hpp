#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>

#include "campaign/workers/cause_of_death.hpp"

namespace fleetproof {

// Watches a worker from outside while it has a run under way, with all processes that it has started. CPU time decides:
// a worker that gets no CPU is not slow. Only if none of its processes can run is it measured by the clock on the wall.
class WorkerWatch {
 public:
  // CPU time, and sleep in a row.
  struct Limits {
    double run_s = 0.0;
    double call_s = std::numeric_limits<double>::infinity();  // of one call into an agent
    // That the processes that it has started may have resident, together.
    std::uint64_t bytes_below = std::numeric_limits<std::uint64_t>::max();
  };
  // `call`: the number of the call into an agent that is under way.
  WorkerWatch(pid_t worker, Limits limits, const std::atomic<std::uint64_t>& call);

  // Call this about every `period_s`. Empty: the worker may go on.
  std::optional<WorkerState> look(double period_s);

 private:
  pid_t worker_;
  Limits limits_;
  const std::atomic<std::uint64_t>& call_;
  std::uint64_t last_call_;
  double begin_s_, call_begin_s_, last_s_;
  std::optional<double> below_begin_s_;  // of the processes that it has started
  double asleep_s_ = 0.0;
};

}  // namespace fleetproof
