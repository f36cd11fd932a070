#pragma once

#include <sys/types.h>

#include <functional>
#include <mutex>
#include <vector>

#include "campaign/workers/channel.hpp"

namespace fleetproof {

// How a worker process ended.
struct WorkerDeath {
  int status = 0;                 // as of waitpid
  bool had_to_be_killed = false;  // it still lived when it was collected
  double cpu_s = 0.0;
  long max_memory_kb = 0;
};

// A process without threads that forks the workers and sees them die. It is itself forked from the constructor, so make
// a Forker before any thread is started and before any file is opened that workers must not hold. It opens no file, and
// it ends with the process that made it: it then kills the workers and what they have started. Threads: any number.
class Forker {
 public:
  // What a worker process does, given its slot and its end of the channel. It never returns.
  using Work = std::function<void(int slot, Channel channel)>;

  explicit Forker(const Work& work);  // throws MachineError
  ~Forker();                          // ends all workers
  Forker(const Forker&) = delete;
  Forker& operator=(const Forker&) = delete;

  struct Worker {
    pid_t pid = 0;
    Channel channel;
  };
  // Throws MachineError if the forker is gone or no process can be started.
  Worker start(int slot);
  // Waits for the end of the worker; kills it, and the processes that it has started, if it does not end by itself.
  WorkerDeath collect(pid_t pid);

 private:
  std::mutex mutex_;
  int control_ = -1;
  pid_t forker_ = 0;
};

}  // namespace fleetproof
