#include "campaign/batch/task_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>

namespace fleetproof::task_pool_test {
namespace {

using Pool = TaskPool<std::uint64_t>;

std::uint64_t same(std::uint64_t index) { return index; }

std::multiset<std::uint64_t> drain(Pool& pool) {
  std::multiset<std::uint64_t> indices;
  pool.take_all([&](std::uint64_t index, std::uint64_t result) {
    EXPECT_EQ(index, result);
    indices.insert(index);
  });
  return indices;
}

TEST(TaskPool, GivesEveryIndexExactlyOnce) {
  for (const int workers : {1, 2, 7}) {
    Pool pool({.workers = workers, .begin = 10, .end = 510, .window = 64}, same);
    const auto indices = drain(pool);
    ASSERT_EQ(indices.size(), 500U) << workers;
    EXPECT_EQ(std::set<std::uint64_t>(indices.begin(), indices.end()).size(), 500U);
    EXPECT_EQ(*indices.begin(), 10U);
    EXPECT_EQ(*indices.rbegin(), 509U);
  }
}

TEST(TaskPool, ReallyRunsOnAsManyThreadsAsAsked) {
  std::atomic<int> inside{0};
  // Seven runs that can only end together: fewer threads would wait for ever, so there is a way out after five seconds.
  Pool pool({.workers = 7, .end = 7}, [&](std::uint64_t index) {
    ++inside;
    for (int i = 0; i < 5000 && inside < 7; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return index;
  });
  EXPECT_EQ(drain(pool).size(), 7U);
  EXPECT_EQ(pool.threads_seen(), 7);
}

// What a pool did while task 0 waited until `count` others had been taken.
struct Waiting {
  std::set<std::uint64_t> before;
  std::uint64_t newest = 0, all = 0;
};

Waiting beside_a_slow_task(const TaskRange& range, std::size_t count) {
  Waiting result;
  std::atomic<bool> release{false};
  std::atomic<std::uint64_t> newest{0};
  Pool pool(range, [&](std::uint64_t index) {
    while (index == 0 && !release) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    for (std::uint64_t known = newest; known < index && !newest.compare_exchange_weak(known, index);) {
    }
    return index;
  });
  pool.take_all([&](std::uint64_t index, std::uint64_t) {
    ++result.all;
    if (release) return;
    result.before.insert(index);
    if (result.before.size() < count) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // for tasks that should not begin
    result.newest = newest;
    release = true;
  });
  return result;
}

TEST(TaskPool, OneSlowRunStallsNothingButTheWindow) {
  const Waiting others = beside_a_slow_task({.workers = 2, .end = 1000, .window = 50}, 49);
  EXPECT_EQ(*others.before.rbegin(), 49U);
  EXPECT_EQ(others.newest, 49U) << "task 50 would be more than a window ahead of task 0";
  EXPECT_EQ(others.all, 1000U);
}

TEST(TaskPool, ResultsThatNobodyTakesStopTheRuns) {
  constexpr int kHandedOver = 1;  // of two workers: the task of the other when the window is full
  std::atomic<int> simulated{0};
  Pool pool({.workers = 2, .end = 1000, .window = 50}, [&](std::uint64_t index) {
    ++simulated;
    return index;
  });
  while (simulated < 50) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // for runs that should not begin
  EXPECT_LE(simulated, 50 + kHandedOver);
  EXPECT_EQ(drain(pool).size(), 1000U);
}

TEST(TaskPool, AtMost512ResultsAreUntakenHoweverLargeTheWindowIs) {
  constexpr int kHandedOver = 1;  // of two workers: the task of the other when no more results are wanted
  std::atomic<int> simulated{0};
  Pool pool({.workers = 2, .end = 3000, .window = 65'536}, [&](std::uint64_t index) {
    ++simulated;
    return index;
  });
  for (int i = 0; i < 10'000 && simulated < 512; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // for runs that should not begin
  EXPECT_GE(simulated, 512);
  EXPECT_LE(simulated, 512 + kHandedOver);
  EXPECT_EQ(drain(pool).size(), 3000U);
}

TEST(TaskPool, StopsHandingOut) {
  Pool pool({.workers = 2, .end = 1'000'000'000}, same);
  std::uint64_t taken = 0;
  pool.take_all([&](std::uint64_t, std::uint64_t) { ++taken; }, [&] { pool.stop(); });
  EXPECT_LT(taken, 100'000U);
}

TEST(TaskPool, PassesOnWhatARunThrows) {
  Pool pool({.workers = 2, .end = 100, .window = 64}, [](std::uint64_t index) {
    if (index == 5) throw std::runtime_error("planted");
    return index;
  });
  EXPECT_THROW(drain(pool), std::runtime_error);
}

// A stop lets the group that was begun come to its end, and begins no other.
TEST(TaskPool, StopsAfterTheGroupThatWasBegun) {
  for (const std::uint64_t held : {0ULL, 9ULL, 12ULL, 95ULL}) {
    std::atomic<bool> begun{false}, release{false};
    Pool pool({.workers = 1, .end = 97}, [&](std::uint64_t index) {
      begun = begun || index == held;
      while (index == held && !release) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return index;
    });
    while (!begun) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    pool.stop_after_group(10);
    pool.stop_after_group(10);
    release = true;
    EXPECT_EQ(drain(pool).size(), std::min<std::uint64_t>(97, (held / 10 + 1) * 10)) << held;
  }
}

// Each thread that is at work when all of them are has one group, from its first run on.
TEST(TaskPool, AThreadStaysWithItsGroup) {
  std::mutex mutex;
  std::map<std::uint64_t, std::set<std::thread::id>> threads;  // by group
  Pool pool({.workers = 2, .end = 400, .group = 8}, [&](std::uint64_t index) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    const std::lock_guard lock(mutex);
    threads[index / 8].insert(std::this_thread::get_id());
    return index;
  });
  EXPECT_EQ(drain(pool).size(), 400U);
  EXPECT_EQ(threads.size(), 50U);
  const auto shared = std::ranges::count_if(threads, [](const auto& group) { return group.second.size() > 1; });
  EXPECT_LE(shared, 2) << "only the last ones are shared";
}

TEST(TaskPool, OneSlowRunDoesNotHoldUpItsGroup) {
  const Waiting others =
      beside_a_slow_task({.workers = 2, .end = 1000, .window = 50, .done = {7, 8, 30}, .group = 10}, 46);
  EXPECT_EQ(*others.before.begin(), 1U);
  EXPECT_EQ(*others.before.rbegin(), 49U);
  EXPECT_EQ(others.newest, 49U) << "task 50 would be more than a window ahead of task 0";
  EXPECT_EQ(others.all, 997U);
}

TEST(TaskPool, ATaskMayHaveNoResult) {
  TaskPool<std::uint64_t> pool({.workers = 2, .end = 100}, [](std::uint64_t index) {
    return index % 2 == 0 ? std::optional(index) : std::nullopt;
  });
  EXPECT_EQ(drain(pool).size(), 50U);
}

TEST(TaskPool, TheCallerHasAWordBetweenResults) {
  std::atomic<bool> release{false};
  Pool pool({.workers = 1, .end = 1}, [&](std::uint64_t index) {
    while (!release) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return index;
  });
  int words = 0;
  pool.take_all([](std::uint64_t, std::uint64_t) {}, [&] { release = ++words >= 3; });
  EXPECT_GE(words, 4);
}

}  // namespace
}  // namespace fleetproof::task_pool_test
