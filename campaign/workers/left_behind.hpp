#pragma once

#include <memory>

namespace fleetproof {

// What software may leave behind in its process, beside memory: locale, signal mask, handlers, alternate stack, working
// folder, umask, limits, timers, environment, descriptors and threads. What there is when the object is made is the
// software's own: it was set while the software was loaded. Threads: the one that calls the agents.
class LeftBehind {
 public:
  LeftBehind();
  ~LeftBehind();

  // Between these two, calls of the system are noticed: software that has made none has left nothing there.
  void run_begins();
  void run_ended();
  // Whether there was such a call since the run began: without one nothing was printed.
  bool has_called_yet() const;
  // Call it between two runs. Sets back what the next run would meet. False: that cannot be done, so this process must
  // host no other run. Descriptors and threads that are there after the first run may stay; more may not.
  bool set_back();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fleetproof
