#include "storage/write_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/base/error.hpp"
#include "storage/target_file.hpp"

namespace fleetproof {
namespace {

// The lock file is always empty. A file with content belongs to another program and must not be removed at the end.
bool could_be_ours(const struct stat& opened) { return S_ISREG(opened.st_mode) && opened.st_size == 0; }

}  // namespace

WriteLock::WriteLock(const std::string& path) : lock_path_(path + ".lock") {
  while (!try_lock(path)) {
  }
}

// False if the former holder removed the file between our open and our lock: no other program would then see our lock.
bool WriteLock::try_lock(const std::string& path) {
  constexpr int kFlags = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  int fd = ::open(lock_path_.c_str(), O_RDWR | O_CREAT | kFlags, 0644);
  if (fd < 0 && errno == EACCES) fd = ::open(lock_path_.c_str(), O_RDONLY | kFlags);  // another user's, who may hold it
  if (fd < 0 && errno == ENOENT) errno = EACCES;  // there is none, and none may be made
  if (fd < 0) throw_cannot_make(lock_path_, errno);
  const int error = ::flock(fd, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
  struct stat opened {
  }, named{};
  const bool known = ::fstat(fd, &opened) == 0;
  const bool still_named = known && ::lstat(lock_path_.c_str(), &named) == 0 && named.st_ino == opened.st_ino &&
                           named.st_dev == opened.st_dev;
  if (error == 0 && still_named && could_be_ours(opened)) {
    fd_ = fd;
    return true;
  }
  ::close(fd);
  if (error == EWOULDBLOCK)
    throw InputError(path, "another fleetproof run is writing this file; wait for it to end, or give another name");
  if (error != 0) {
    throw InputError(
        lock_path_,
        fmt::format("this file cannot be locked ({}); name a folder on a disk that has locks, such as a local one",
                    std::strerror(error)));
  }
  if (still_named)
    throw InputError(
        lock_path_,
        "this file is not of fleetproof and stands in the way; remove it, or give the results file another name");
  return false;
}

void WriteLock::release() {
  if (fd_ < 0) return;
  ::unlink(lock_path_.c_str());  // while it is still ours
  ::flock(fd_, LOCK_UN);         // a forked child may hold a copy of the descriptor
  ::close(fd_);
  fd_ = -1;
}

}  // namespace fleetproof
