#include "campaign/workers/worker_watch.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace fleetproof {
namespace {

constexpr double kAnyWork_s = 0.001;  // a worker that uses less CPU time in a period waits

}  // namespace

// The state stands behind the name of the program, which is in brackets and may hold anything.
char process_state(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string line;
  std::getline(file, line);
  const auto end_of_name = line.rfind(')');
  return end_of_name != std::string::npos && end_of_name + 2 < line.size() ? line[end_of_name + 2] : 'X';
}

WorkerWatch::WorkerWatch(pid_t worker, Limits limits, const std::atomic<std::uint64_t>& call)
    : worker_(worker),
      limits_(limits),
      call_(call),
      last_call_(call),
      begin_s_(cpu_s().value_or(0.0)),
      call_begin_s_(begin_s_),
      last_s_(begin_s_) {}

std::optional<double> WorkerWatch::cpu_s() const {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(worker_, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return std::nullopt;
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

std::optional<WorkerState> WorkerWatch::look(double period_s) {
  const auto now_s = cpu_s();
  const char state_now = process_state(worker_);
  // A process that it has started may keep the channel open.
  if (!now_s || state_now == 'Z' || state_now == 'X') return WorkerState::Closed;
  if (last_call_ != call_) {
    last_call_ = call_;
    call_begin_s_ = *now_s;
  }
  if (*now_s - begin_s_ > limits_.run_s || *now_s - call_begin_s_ > limits_.call_s) return WorkerState::BeyondCpuLimit;
  const bool idle = *now_s - last_s_ < kAnyWork_s && state_now != 'R';
  asleep_s_ = idle ? asleep_s_ + period_s : 0.0;
  last_s_ = *now_s;
  if (asleep_s_ > std::min(limits_.run_s, limits_.call_s)) return WorkerState::Asleep;
  return std::nullopt;
}

}  // namespace fleetproof
