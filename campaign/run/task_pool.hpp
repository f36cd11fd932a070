#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "storage/records.hpp"

namespace fleetproof {

// Independent runs on a TBB task pool: index in, record out. The caller's thread never works in the pool; it takes the
// results, in the order in which they finish. `simulate` is called from several threads at once and must be a pure
// function of the index.
class TaskPool {
 public:
  using Simulate = std::function<RunRecord(std::uint64_t run_index)>;

  // Starts `workers` threads on the runs [begin, end). At most `window` runs lie between the oldest unfinished one and
  // the newest handed out.
  TaskPool(int workers, std::uint64_t begin, std::uint64_t end, std::uint64_t window, Simulate simulate);
  // Hands out no more runs and waits for those under way.
  ~TaskPool();
  TaskPool(const TaskPool&) = delete;
  TaskPool& operator=(const TaskPool&) = delete;

  // The next finished run; nothing if none finished within `patience`. Rethrows what a run threw.
  std::optional<RunRecord> next(std::chrono::milliseconds patience);
  // All runs handed out have been taken and no more will come.
  bool finished() const;
  void stop();               // hand out no more
  int threads_seen() const;  // different threads that have simulated so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fleetproof
