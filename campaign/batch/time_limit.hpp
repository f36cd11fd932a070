#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace fleetproof {

// How long work may take: until a deadline, or until somebody wants it to end. A thread of its own looks at both, so
// that a long simulation that knows the flag ends in its middle. Threads: any number.
class TimeLimit {
 public:
  using Clock = std::chrono::steady_clock;

  // No deadline: none. `wants_end` is asked a hundred times a second.
  explicit TimeLimit(
      std::optional<Clock::time_point> deadline = {}, std::function<bool()> wants_end = [] { return false; });
  ~TimeLimit();
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

  bool is_over() const { return over_; }
  const std::atomic<bool>& over() const { return over_; }

 private:
  void watch();

  const std::optional<Clock::time_point> deadline_;
  const std::function<bool()> wants_end_;
  std::atomic<bool> over_ = false;
  std::mutex mutex_;
  std::condition_variable leaving_;
  bool is_leaving_ = false;
  std::thread thread_;
};

}  // namespace fleetproof
