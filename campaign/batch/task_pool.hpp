#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "storage/records.hpp"

namespace fleetproof {

// A run that was handed out and has not finished.
struct RunUnderWay {
  std::uint64_t run_index = 0;
  double since_s = 0.0;  // for so long
};

// Independent runs on a TBB task pool: an index goes in, a record comes out. The caller's thread never works in the
// pool. It takes the results in the order in which they finish. Requires: `simulate` is a pure function of the index.
// Several threads call it at once.
class TaskPool {
 public:
  // None: the run was abandoned.
  using Simulate = std::function<std::optional<RunRecord>(std::uint64_t run_index)>;

  // Starts `workers` threads on the runs [begin, end). At most `window` runs lie between the oldest unfinished run and
  // the newest run that was handed out. The runs in `done` are not handed out. Runs of one stretch of this length, from
  // run 0 on, have much in common: a thread stays with its stretch, unless another one has nothing else to do.
  // Workers wait while 512 results are not taken.
  TaskPool(int workers, std::uint64_t begin, std::uint64_t end, std::uint64_t window, Simulate simulate,
           std::set<std::uint64_t> done = {}, std::uint64_t stretch = 1);
  // Hands out no more runs and waits for the runs under way.
  ~TaskPool();
  TaskPool(const TaskPool&) = delete;
  TaskPool& operator=(const TaskPool&) = delete;

  // The next finished run; none if no run finished within `patience`. Rethrows an exception of a run.
  std::optional<RunRecord> next(std::chrono::milliseconds patience);
  // Whether all runs that were handed out have been taken, and no more will come.
  bool finished() const;
  void stop();  // hands out no more runs
  // The same, after the runs that belong to the last stretch which was begun: stretches of this length, from run 0 on.
  void stop_after_stretch(std::uint64_t length);
  std::vector<RunUnderWay> under_way() const;  // in order of run index
  int threads_seen() const;                    // the number of different threads that have simulated so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fleetproof
