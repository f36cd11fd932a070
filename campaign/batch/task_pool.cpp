#include "campaign/batch/task_pool.hpp"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

// Debian's TBB is not instrumented, so the thread sanitizer sees no order between submitting a task and running it.
// This counter restates that order where it can be seen.
std::atomic<std::uint64_t> handed_over{0};

// Results that nobody has taken. On a busy machine the caller may fall behind the workers: they then wait, and memory
// stays flat. Enough for the 50 ms of a commit at 10 000 runs a second.
constexpr std::size_t kMostUntaken = 512;

// The caller is woken for so many results, or when it has waited for this time: to wake it takes longer than a short
// run.
constexpr std::size_t kAtOnce = 32;
constexpr std::chrono::milliseconds kPatience{10};

}  // namespace

struct AnyTaskPool::Impl {
  const TaskRange range;
  const Task task;

  mutable std::mutex mutex;
  std::condition_variable room, results, ended;
  std::uint64_t end;                             // of the tasks to do: a stop brings it nearer
  std::uint64_t next_index;                      // the next group begins here
  std::map<std::uint64_t, std::uint64_t> open;   // by number of a group that was begun: its next task to hand out
  std::map<std::thread::id, std::uint64_t> own;  // the group that a thread began last
  std::map<std::uint64_t, std::chrono::steady_clock::time_point> under_way;  // handed out when, not yet finished
  std::deque<std::pair<std::uint64_t, std::any>> done;
  std::set<std::thread::id> threads;
  std::exception_ptr failure;
  const std::size_t most_untaken = std::min<std::size_t>(range.window, kMostUntaken);
  const std::size_t at_once = std::min(kAtOnce, most_untaken);
  int working = range.workers;  // threads that have not come to their end
  bool stopping = false, crew_gone = false;
  std::thread crew;

  Impl(TaskRange tasks_to_do, Task function)
      : range(std::move(tasks_to_do)), task(std::move(function)), end(range.end), next_index(not_done(range.begin)) {
    ensure(range.workers >= 1 && range.window >= 1 && range.group >= 1,
           "a pool has at least one worker and room for one task");
    crew = std::thread([this] { feed(); });
  }

  // The one functor that TBB copies from thread to thread. tests/tsan.supp names this type, so it must do nothing but
  // forward.
  struct ForwardToPool {
    Impl* pool;
    void operator()() const {
      (void)handed_over.load(std::memory_order_acquire);
      pool->work();
    }
  };

  // The feeder occupies one slot of the arena but does no task, so exactly `workers` threads do, however many cores
  // there are. group.wait() would lend it to the pool as one more worker; so it waits until nothing is left to lend it
  // for.
  void feed() {
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(range.workers) + 1);
    tbb::task_arena arena(range.workers + 1, 1);
    tbb::task_group group;
    arena.initialize();
    handed_over.fetch_add(1, std::memory_order_release);
    for (int worker = 0; worker < range.workers; ++worker) arena.execute([&] { group.run(ForwardToPool{this}); });
    {
      std::unique_lock lock(mutex);
      ended.wait(lock, [&] { return working == 0; });
    }
    arena.execute([&] { group.wait(); });
    const std::lock_guard lock(mutex);
    crew_gone = true;
    results.notify_all();
  }

  std::uint64_t not_done(std::uint64_t index) const {
    while (range.done.contains(index)) ++index;
    return index;
  }
  bool more_to_do() const { return !stopping && (next_index < end || !open.empty()); }

  // Not handed out, or not finished.
  std::uint64_t oldest() const {
    std::uint64_t index = next_index;
    if (!under_way.empty()) index = std::min(index, under_way.begin()->first);
    for (const auto& [number, next] : open) index = std::min(index, next);
    return index;
  }

  // The group from which this thread takes its next task: its own, else a new one. If there is no room or none left,
  // it helps with the oldest. `open.end()`: it must wait.
  std::map<std::uint64_t, std::uint64_t>::iterator choose() {
    const std::uint64_t within = oldest() + range.window;
    const auto mine = own.find(std::this_thread::get_id());
    auto chosen = mine == own.end() ? open.end() : open.find(mine->second);
    if (chosen != open.end() && chosen->second < within) return chosen;
    if (next_index < std::min(end, within)) return begin_group();
    return !open.empty() && open.begin()->second < within ? open.begin() : open.end();
  }

  std::map<std::uint64_t, std::uint64_t>::iterator begin_group() {
    const std::uint64_t number = next_index / range.group;
    const auto begun = open.emplace(number, next_index).first;
    own[std::this_thread::get_id()] = number;
    next_index = not_done(std::min(end, (number + 1) * range.group));
    return begun;
  }

  std::uint64_t hand_out(std::map<std::uint64_t, std::uint64_t>::iterator from) {
    const std::uint64_t index = from->second;
    from->second = not_done(index + 1);
    if (from->second >= std::min(end, (from->first + 1) * range.group)) open.erase(from);
    return index;
  }

  // What TBB calls a task is one of the threads: it does tasks of ours until none is left. To hand each over by itself
  // would wake three threads for it. Even a thread that finds no memory for the books of the pool comes to its end
  // here: all others wait for it.
  void work() {
    std::unique_lock lock(mutex);
    try {
      work_while_tasks_are_left(lock);
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      if (!failure) failure = std::current_exception();
      stopping = true;
      room.notify_all();
    }
    --working;
    ended.notify_all();
  }

  void work_while_tasks_are_left(std::unique_lock<std::mutex>& lock) {
    while (const auto index = next_task(lock)) {
      lock.unlock();
      std::any result;
      std::exception_ptr error;
      try {
        result = task(*index);
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      finish(*index, std::move(result), error);
    }
  }

  std::optional<std::uint64_t> next_task(std::unique_lock<std::mutex>& lock) {
    auto from = open.end();
    room.wait(lock, [&] { return !more_to_do() || (done.size() < most_untaken && (from = choose()) != open.end()); });
    if (!more_to_do()) return std::nullopt;
    const std::uint64_t index = hand_out(from);
    under_way.emplace(index, std::chrono::steady_clock::now());
    threads.insert(std::this_thread::get_id());
    return index;
  }

  void finish(std::uint64_t index, std::any result, const std::exception_ptr& error) {
    under_way.erase(index);
    if (result.has_value()) done.emplace_back(index, std::move(result));
    if (error && !failure) failure = error;
    if (error) stopping = true;
    if (done.size() >= at_once) results.notify_all();
    room.notify_all();
  }
};

AnyTaskPool::AnyTaskPool(TaskRange range, Task task)
    : impl_(std::make_unique<Impl>(std::move(range), std::move(task))) {}

AnyTaskPool::~AnyTaskPool() {
  stop();
  impl_->crew.join();
}

void AnyTaskPool::stop() {
  const std::lock_guard lock(impl_->mutex);
  impl_->stopping = true;
  impl_->room.notify_all();
}

void AnyTaskPool::stop_after_group(std::uint64_t length) {
  const std::lock_guard lock(impl_->mutex);
  const std::uint64_t groups = (impl_->next_index + length - 1) / length;
  impl_->end = std::min(impl_->end, groups * length);
  impl_->room.notify_all();
}

void AnyTaskPool::take_all(const Take& take, const std::function<void()>& meanwhile) {
  std::unique_lock lock(impl_->mutex);
  while (!impl_->crew_gone || !impl_->done.empty()) {
    if (impl_->done.empty()) {
      impl_->results.wait_for(lock, kPatience,
                              [&] { return impl_->done.size() >= impl_->at_once || impl_->crew_gone; });
    }
    std::optional<std::pair<std::uint64_t, std::any>> next;
    if (!impl_->done.empty()) {
      next = std::move(impl_->done.front());
      impl_->done.pop_front();
      impl_->room.notify_all();
    }
    lock.unlock();
    if (next) take(next->first, next->second);
    meanwhile();
    lock.lock();
  }
  if (impl_->failure) std::rethrow_exception(impl_->failure);
}

std::vector<TaskUnderWay> AnyTaskPool::under_way() const {
  const auto now = std::chrono::steady_clock::now();
  const std::lock_guard lock(impl_->mutex);
  std::vector<TaskUnderWay> tasks;
  for (const auto& [index, since] : impl_->under_way)
    tasks.push_back({index, std::chrono::duration<double>(now - since).count()});
  return tasks;
}

int AnyTaskPool::threads_seen() const {
  const std::lock_guard lock(impl_->mutex);
  return static_cast<int>(impl_->threads.size());
}

}  // namespace fleetproof
