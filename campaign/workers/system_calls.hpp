#pragma once

namespace fleetproof {

// Notices whether this thread has called the system. What a process holds outside its own memory (limits, handlers,
// timers, descriptors, threads, the working folder) cannot change without such a call. Processors and kernels that
// cannot tell say always that it has. Threads: the one that made it.
class SystemCalls {
 public:
  SystemCalls();

  void begin();  // from now on
  // Whether there was any since `begin`. The second ends the watch.
  bool any_yet() const;
  bool any();

 private:
  bool can_tell_;
};

}  // namespace fleetproof
