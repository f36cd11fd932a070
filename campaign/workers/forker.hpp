#pragma once

#include <sys/types.h>

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "campaign/workers/channel.hpp"

namespace fleetproof {

// How a worker process ended.
struct WorkerDeath {
  int status = 0;                 // as of waitpid
  bool had_to_be_killed = false;  // it still lived when it was collected
  bool with_forker = false;       // the process that started it was killed, and it died with it; nothing else is known
  double cpu_s = 0.0;
  long max_memory_kb = 0;
};

// With this exit code a worker ends whose program cannot be started.
inline constexpr int kCannotStartExit = 98;

// What a worker process is: a program, started by `exec`, so that it has addresses of its own.
struct WorkerProgram {
  std::string file;                // its main() begins with serve_forker_if_called
  std::vector<std::string> words;  // before two more: the numbers of its channel and of its slot
  std::vector<int> descriptors{};  // stay open in it, as well as its channel
  std::vector<int> logs{};         // by slot: takes what it prints; none or -1: that is dropped
};

struct ForkRequest;
struct ForkReply;

// A process of one thread that starts the workers and sees them die. It holds no file but theirs. It ends with the
// process that made it: it then kills the workers and what they have started. Software in a worker may kill or stop it:
// it is then started again, or continued. Threads: any number.
class Forker {
 public:
  explicit Forker(WorkerProgram program);  // throws MachineError
  ~Forker();                               // ends all workers
  Forker(const Forker&) = delete;
  Forker& operator=(const Forker&) = delete;

  struct Worker {
    pid_t pid = 0;
    Channel channel;
    std::uint64_t forker = 0;  // the number of the process that has started it
  };
  // Throws MachineError if no process can be started.
  Worker start(int slot);
  // Waits for the end of the worker; kills it, and the processes that it has started, if it does not end by itself.
  WorkerDeath collect(const Worker& worker);

 private:
  void start_process();
  void end_process();
  bool ask(const ForkRequest& request, int descriptor, ForkReply& reply);

  WorkerProgram program_;
  std::mutex mutex_;
  int control_ = -1;
  pid_t forker_ = 0;
  std::uint64_t number_ = 0;  // counts the processes that were forker
};

// Call this first in main(). If a Forker has started this process as its own, it serves and never returns.
void serve_forker_if_called(int argc, const char* const* argv);

}  // namespace fleetproof
