#include "campaign/workers/worker_watch.hpp"

#include <algorithm>

#include "campaign/workers/process_tree.hpp"

namespace fleetproof {
namespace {

constexpr double kAnyWork_s =
    0.001;  // a worker that uses less CPU time in a period waits, with all that it has started

}  // namespace

WorkerWatch::WorkerWatch(pid_t worker, Limits limits, const std::atomic<std::uint64_t>& call)
    : worker_(worker),
      limits_(limits),
      call_(call),
      last_call_(call),
      begin_s_(own_cpu_s(worker)),
      call_begin_s_(begin_s_),
      last_s_(begin_s_) {}

std::optional<WorkerState> WorkerWatch::look(double period_s) {
  const TreeUse use = use_of_tree(worker_);
  const char state_now = process_state(worker_);
  // A process that it has started may keep the channel open.
  if (!use.is_there || state_now == 'Z' || state_now == 'X') return WorkerState::Closed;
  // What its processes have used before the first look belongs to earlier runs, but for a moment.
  if (!below_begin_s_) below_begin_s_ = use.below_s;
  const double now_s = use.own_s + std::max(0.0, use.below_s - *below_begin_s_);
  if (last_call_ != call_) {
    last_call_ = call_;
    call_begin_s_ = now_s;
  }
  if (now_s - begin_s_ > limits_.run_s || now_s - call_begin_s_ > limits_.call_s) return WorkerState::BeyondCpuLimit;
  if (use.resident_bytes_below > limits_.bytes_below) return WorkerState::BeyondMemory;
  const bool idle = now_s - last_s_ < kAnyWork_s && !can_run_in_tree(worker_);
  asleep_s_ = idle ? asleep_s_ + period_s : 0.0;
  last_s_ = now_s;
  if (asleep_s_ > std::min(limits_.run_s, limits_.call_s)) return WorkerState::Asleep;
  return std::nullopt;
}

}  // namespace fleetproof
