#include "campaign/batch/time_limit.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof {
namespace {

constexpr std::chrono::milliseconds kAskEvery{10};

}  // namespace

TimeLimit::TimeLimit(std::optional<Clock::time_point> deadline, std::function<bool()> wants_end)
    : deadline_(deadline), wants_end_(std::move(wants_end)), thread_([this] { watch(); }) {}

TimeLimit::~TimeLimit() {
  {
    const std::lock_guard lock(mutex_);
    is_leaving_ = true;
  }
  leaving_.notify_all();
  thread_.join();
}

void TimeLimit::watch() {
  std::unique_lock lock(mutex_);
  while (!is_leaving_) {
    const auto now = Clock::now();
    if ((deadline_ && now >= *deadline_) || wants_end_()) {
      over_ = true;
      return;
    }
    const auto next = now + kAskEvery;
    leaving_.wait_until(lock, deadline_ ? std::min(*deadline_, Clock::time_point(next)) : Clock::time_point(next));
  }
}

}  // namespace fleetproof
