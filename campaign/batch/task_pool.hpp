#pragma once

#include <any>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace fleetproof {

// A task that was handed out and has not finished.
struct TaskUnderWay {
  std::uint64_t index = 0;
  double since_s = 0.0;  // for so long
};

// Which tasks a pool does, and how.
struct TaskRange {
  int workers = 1;                   // threads that are started
  std::uint64_t begin = 0, end = 0;  // the tasks [begin, end)
  // So many tasks lie at most between the oldest unfinished task and the newest task that was handed out.
  std::uint64_t window = 1024;
  std::set<std::uint64_t> done{};  // these are not handed out
  // Tasks of one group of this length, from task 0 on, have much in common: a thread stays with its group, unless
  // another one has nothing else to do.
  std::uint64_t group = 1;
};

// What is the same for results of every type. Use TaskPool.
class AnyTaskPool {
 public:
  AnyTaskPool(const AnyTaskPool&) = delete;
  AnyTaskPool& operator=(const AnyTaskPool&) = delete;

  void stop();  // hands out no more tasks
  // The same, after the tasks that belong to the last group which was begun: groups of this length, from task 0
  // on.
  void stop_after_group(std::uint64_t length);
  std::vector<TaskUnderWay> under_way() const;  // in order of index
  int threads_seen() const;                     // the number of different threads that have done a task so far

 protected:
  using Task = std::function<std::any(std::uint64_t index)>;  // empty: there is no result
  using Take = std::function<void(std::uint64_t index, std::any& result)>;

  AnyTaskPool(TaskRange range, Task task);
  ~AnyTaskPool();
  void take_all(const Take& take, const std::function<void()>& meanwhile);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Independent tasks on the threads of TBB: an index goes in, a result comes out. The caller's thread never works in
// the pool. Requires: the result is a pure function of the index. Several threads call it at once. Workers wait while
// 512 results are not taken. The destructor hands out no more tasks and waits for those under way.
template <class Result>
class TaskPool : public AnyTaskPool {
 public:
  // None: the task was abandoned, or has no result.
  using Function = std::function<std::optional<Result>(std::uint64_t index)>;

  // Starts the threads.
  TaskPool(TaskRange range, Function function)
      : AnyTaskPool(std::move(range), [function = std::move(function)](std::uint64_t index) {
          std::optional<Result> result = function(index);
          return result ? std::make_any<Result>(*std::move(result)) : std::any();
        }) {}

  // Takes the results, in the order in which they finish, until all tasks that are handed out have finished. Calls
  // `meanwhile` after each result, and every 10 ms without one; it may stop the pool. Rethrows an exception of a task.
  void take_all(
      const std::function<void(std::uint64_t index, Result result)>& take,
      const std::function<void()>& meanwhile = [] {}) {
    AnyTaskPool::take_all(
        [&](std::uint64_t index, std::any& result) { take(index, std::move(*std::any_cast<Result>(&result))); },
        meanwhile);
  }
};

}  // namespace fleetproof
