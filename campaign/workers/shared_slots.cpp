#include "campaign/workers/shared_slots.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <new>

#include "core/base/machine_error.hpp"

namespace fleetproof {

static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "a lock would be private to one process");

SharedSlots::SharedSlots(int count) : count_(count) {
  const std::size_t size = sizeof(WorkerSlot) * static_cast<std::size_t>(count);
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    throw MachineError(fmt::format("no memory can be shared with worker processes: {}", std::strerror(errno)));
  slots_ = static_cast<WorkerSlot*>(memory);
  for (int i = 0; i < count; ++i) new (slots_ + i) WorkerSlot;
}

SharedSlots::~SharedSlots() { ::munmap(slots_, sizeof(WorkerSlot) * static_cast<std::size_t>(count_)); }

}  // namespace fleetproof
