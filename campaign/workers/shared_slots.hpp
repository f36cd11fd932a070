#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "core/engine/run_watch.hpp"

namespace fleetproof {

// What a worker process writes down for the time after its death. Which run it was in, the main process knows.
struct WorkerSlot {
  std::atomic<std::uint32_t> started{0};         // 1: the program of the worker runs
  std::atomic<std::uint32_t> stack_overflow{0};  // 1: the fatal signal came from the guard page of the stack
  // Bytes at the begin of the worker's log whose lines have a label (worker_logs.hpp).
  std::atomic<std::uint64_t> labelled{0};
  CallNote call;
};

// One slot for each worker, in memory that main process, forker and workers share. A process that dies leaves its slot
// as it was.
class SharedSlots {
 public:
  explicit SharedSlots(int count);
  SharedSlots(int count, int fd);  // those that another process has made; takes the descriptor
  ~SharedSlots();
  SharedSlots(const SharedSlots&) = delete;
  SharedSlots& operator=(const SharedSlots&) = delete;

  int count() const { return count_; }
  int fd() const { return fd_; }  // of the memory; it is closed when a program is started
  WorkerSlot& operator[](int slot) const { return slots_[slot]; }

 private:
  void map();

  int count_, fd_;
  WorkerSlot* slots_ = nullptr;
};

}  // namespace fleetproof
