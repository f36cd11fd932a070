#include "campaign/workers/shared_slots.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

[[noreturn]] void throw_no_memory() {
  throw MachineError(fmt::format("no memory can be shared with worker processes: {}", std::strerror(errno)));
}

}  // namespace

static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "a lock would be private to one process");

SharedSlots::SharedSlots(int count) : count_(count), fd_(::memfd_create("fleetproof-slots", MFD_CLOEXEC)) {
  if (fd_ < 0 || ::ftruncate(fd_, static_cast<off_t>(sizeof(WorkerSlot)) * count) != 0) throw_no_memory();
  map();
  for (int i = 0; i < count; ++i) new (slots_ + i) WorkerSlot;
}

SharedSlots::SharedSlots(int count, int fd) : count_(count), fd_(fd) {
  ::fcntl(fd_, F_SETFD, FD_CLOEXEC);
  struct stat status {};
  if (::fstat(fd_, &status) != 0 || status.st_size < static_cast<off_t>(sizeof(WorkerSlot)) * count)
    throw EngineError("no slot of a worker is shared with this program");
  map();
}

void SharedSlots::map() {
  const std::size_t size = sizeof(WorkerSlot) * static_cast<std::size_t>(count_);
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, fd_, 0);
  if (memory == MAP_FAILED) throw_no_memory();
  slots_ = static_cast<WorkerSlot*>(memory);
}

SharedSlots::~SharedSlots() {
  ::munmap(slots_, sizeof(WorkerSlot) * static_cast<std::size_t>(count_));
  ::close(fd_);
}

}  // namespace fleetproof
