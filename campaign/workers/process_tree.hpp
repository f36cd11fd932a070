#pragma once

#include <sys/types.h>

#include <cstdint>
#include <vector>

namespace fleetproof {

// R, S, T, Z, ... as /proc tells it; X: there is no such process.
char process_state(pid_t process);

std::vector<pid_t> children_of(pid_t process);
// The children of this process, their children, and so on. A process whose parent has ended belongs to the nearest
// ancestor that takes orphans in (PR_SET_CHILD_SUBREAPER), as workers and forkers do.
std::vector<pid_t> descendants_of(pid_t process);
// Of a session, without those that have ended and wait to be waited for.
std::vector<pid_t> processes_of_session(pid_t session);

// A process and its descendants at one instant.
struct TreeUse {
  double own_s = 0.0;                      // CPU time of the process itself
  double below_s = 0.0;                    // of its descendants, also of those that have ended and been waited for
  std::uint64_t resident_bytes_below = 0;  // of its descendants, shared pages once for each
  bool is_there = false;                   // the process itself is alive
};
TreeUse use_of_tree(pid_t process);
// Of the process alone, which costs much less to know; 0: it is not there.
double own_cpu_s(pid_t process);
// Whether a thread of the tree runs or waits for a processor only.
bool can_run_in_tree(pid_t process);

}  // namespace fleetproof
