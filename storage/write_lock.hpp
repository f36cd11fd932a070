#pragma once

#include <string>

namespace fleetproof {

// Only one program at a time writes a results file: the program that holds PATH.lock. The lock ends with the process,
// even if the process is killed. A PATH.lock file that remains then blocks no program.
// Threads: one.
class WriteLock {
 public:
  // `path` is the results file. Throws InputError if another run holds the lock, or if the place cannot be written.
  // Throws MachineError if the disk fails.
  explicit WriteLock(const std::string& path);
  ~WriteLock() { release(); }
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;

  // Removes the lock file, so that the next program can write.
  void release();

 private:
  bool try_lock(const std::string& path);

  std::string lock_path_;
  int fd_ = -1;
};

}  // namespace fleetproof
