#pragma once

#include <string>

namespace fleetproof {

// Of several programs that would write one campaign file, one holds PATH.lock. The lock goes with the process, even if
// it is killed; a file that is left behind then holds nobody up. Threads: one.
class WriteLock {
 public:
  // `path` is the campaign file. Throws InputError if another run holds the lock, or the place cannot be written;
  // EngineError if the disk refuses.
  explicit WriteLock(const std::string& path);
  ~WriteLock() { release(); }
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;

  // Removes the side file and lets the next one in.
  void release();

 private:
  bool try_lock(const std::string& path);

  std::string lock_path_;
  int fd_ = -1;
};

}  // namespace fleetproof
