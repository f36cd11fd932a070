#include "campaign/batch/task_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

namespace fleetproof::task_pool_test {
namespace {

RunRecord record_of(std::uint64_t index) {
  RunRecord record;
  record.run_index = index;
  return record;
}

std::multiset<std::uint64_t> drain(TaskPool& pool) {
  std::multiset<std::uint64_t> indices;
  while (!pool.finished()) {
    if (const auto record = pool.next(std::chrono::milliseconds(50))) indices.insert(record->run_index);
  }
  return indices;
}

TEST(TaskPool, GivesEveryIndexExactlyOnce) {
  for (const int workers : {1, 2, 7}) {
    TaskPool pool(workers, 10, 510, 64, record_of);
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
  TaskPool pool(7, 0, 7, 64, [&](std::uint64_t index) {
    ++inside;
    for (int i = 0; i < 5000 && inside < 7; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return record_of(index);
  });
  EXPECT_EQ(drain(pool).size(), 7U);
  EXPECT_EQ(pool.threads_seen(), 7);
}

TEST(TaskPool, OneSlowRunStallsNothingButTheWindow) {
  std::atomic<bool> release{false};
  TaskPool pool(2, 0, 1000, 50, [&](std::uint64_t index) {
    while (index == 0 && !release) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return record_of(index);
  });
  std::set<std::uint64_t> before;
  while (before.size() < 49) {
    if (const auto record = pool.next(std::chrono::milliseconds(50))) before.insert(record->run_index);
  }
  EXPECT_FALSE(pool.next(std::chrono::milliseconds(50))) << "run 50 would be more than a window ahead of run 0";
  EXPECT_EQ(*before.rbegin(), 49U);
  release = true;
  EXPECT_EQ(drain(pool).size(), 951U);
}

TEST(TaskPool, ResultsThatNobodyTakesStopTheRuns) {
  constexpr int kHandedOver = 8;  // tasks of two workers that may be on their way when the window is full
  std::atomic<int> simulated{0};
  TaskPool pool(2, 0, 1000, 50, [&](std::uint64_t index) {
    ++simulated;
    return record_of(index);
  });
  while (simulated < 50) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // for runs that should not begin
  EXPECT_LE(simulated, 50 + kHandedOver);
  EXPECT_EQ(drain(pool).size(), 1000U);
}

TEST(TaskPool, AtMost512ResultsAreUntakenHoweverLargeTheWindowIs) {
  constexpr int kHandedOver = 8;  // tasks of two workers that may be on their way when no more results are wanted
  std::atomic<int> simulated{0};
  TaskPool pool(2, 0, 3000, 65'536, [&](std::uint64_t index) {
    ++simulated;
    return record_of(index);
  });
  for (int i = 0; i < 10'000 && simulated < 512; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // for runs that should not begin
  EXPECT_GE(simulated, 512);
  EXPECT_LE(simulated, 512 + kHandedOver);
  EXPECT_EQ(drain(pool).size(), 3000U);
}

TEST(TaskPool, StopsHandingOut) {
  TaskPool pool(2, 0, 1'000'000'000, 1000, record_of);
  (void)pool.next(std::chrono::milliseconds(1000));
  pool.stop();
  EXPECT_LT(drain(pool).size(), 100'000U);
}

TEST(TaskPool, PassesOnWhatARunThrows) {
  TaskPool pool(2, 0, 100, 64, [](std::uint64_t index) {
    if (index == 5) throw std::runtime_error("planted");
    return record_of(index);
  });
  EXPECT_THROW(drain(pool), std::runtime_error);
}

// A stop lets the stretch that was begun come to its end, and begins no other.
TEST(TaskPool, StopsAfterTheStretchThatWasBegun) {
  for (const std::uint64_t held : {0ULL, 9ULL, 12ULL, 95ULL}) {
    std::atomic<bool> begun{false}, release{false};
    TaskPool pool(1, 0, 97, 1000, [&](std::uint64_t index) {
      begun = begun || index == held;
      while (index == held && !release) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return record_of(index);
    });
    while (!begun) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    pool.stop_after_stretch(10);
    pool.stop_after_stretch(10);
    release = true;
    EXPECT_EQ(drain(pool).size(), std::min<std::uint64_t>(97, (held / 10 + 1) * 10)) << held;
  }
}

// Each thread that is at work when all of them are has one stretch, from its first run on.
TEST(TaskPool, AThreadStaysWithItsStretch) {
  std::mutex mutex;
  std::map<std::uint64_t, std::set<std::thread::id>> threads;  // by stretch
  TaskPool pool(
      2, 0, 400, 1000,
      [&](std::uint64_t index) {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        const std::lock_guard lock(mutex);
        threads[index / 8].insert(std::this_thread::get_id());
        return record_of(index);
      },
      {}, 8);
  EXPECT_EQ(drain(pool).size(), 400U);
  EXPECT_EQ(threads.size(), 50U);
  const auto shared = std::ranges::count_if(threads, [](const auto& stretch) { return stretch.second.size() > 1; });
  EXPECT_LE(shared, 2) << "only the last ones are shared";
}

TEST(TaskPool, OneSlowRunDoesNotHoldUpItsStretch) {
  std::atomic<bool> release{false};
  TaskPool pool(
      2, 0, 1000, 50,
      [&](std::uint64_t index) {
        while (index == 0 && !release) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return record_of(index);
      },
      {7, 8, 30}, 10);
  std::set<std::uint64_t> before;
  while (before.size() < 46) {
    if (const auto record = pool.next(std::chrono::milliseconds(50))) before.insert(record->run_index);
  }
  EXPECT_FALSE(pool.next(std::chrono::milliseconds(50))) << "run 50 would be more than a window ahead of run 0";
  EXPECT_EQ(*before.begin(), 1U);
  EXPECT_EQ(*before.rbegin(), 49U);
  release = true;
  EXPECT_EQ(drain(pool).size(), 951U);
}

}  // namespace
}  // namespace fleetproof::task_pool_test
