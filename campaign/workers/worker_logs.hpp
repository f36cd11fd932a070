#pragma once

#include <string>
#include <vector>

namespace fleetproof {

// The files that take what agents print, one for each worker. A file that exists already is left alone: the next free
// number is taken.
class WorkerLogs {
 public:
  // "x" makes x.worker-0.log and so on; an empty prefix makes none. Throws InputError if a file cannot be made.
  WorkerLogs(const std::string& prefix, int count);
  ~WorkerLogs();  // removes the files in which nothing was printed
  WorkerLogs(const WorkerLogs&) = delete;
  WorkerLogs& operator=(const WorkerLogs&) = delete;

  const std::vector<int>& descriptors() const { return descriptors_; }  // by worker; -1: none
  const std::string& path(int worker) const { return paths_[static_cast<std::size_t>(worker)]; }
  // The lines of the last stack trace in the log of a worker (fatal_signals.hpp); empty: there is none.
  std::vector<std::string> last_stack(int worker) const;

 private:
  std::vector<std::string> paths_;
  std::vector<int> descriptors_;
};

}  // namespace fleetproof
