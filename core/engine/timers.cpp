#include "core/engine/timers.hpp"

#include <algorithm>

namespace fleetproof {

Timers::Timers(RunContext& run, AgentHostPort agents) : run_(run), agents_(agents) {
  for (const AgvSetup& agv : run.scenario.agvs) slices_.push_back({.clock = AgentClock(agv.sensing), .timers = {}});
}

void Timers::set(AgvId agv, std::uint32_t number, std::int64_t at_ns) {
  Slice& slice = slices_[agv.index()];
  Timer* timer = find(slice, number);
  if (timer == nullptr) [[unlikely]]
    timer = add(slice, number);
  timer->stamp = at_ns < 0 ? 0 : ++slice.last_stamp;
  if (at_ns < 0) return;
  run_.queue.push_timer(std::max(run_.now, slice.clock.when_it_shows(at_ns)), agv, number, timer->stamp);
}

void Timers::goes_off(AgvId agv, std::uint32_t number, std::uint64_t stamp) {
  Timer* const timer = find(slices_[agv.index()], number);
  if (timer == nullptr || timer->stamp != stamp) return;
  timer->stamp = 0;
  run_.trace(agv, traced::TimerWentOff{number});
  fp_event event{};
  event.kind = FP_EVENT_TIMER;
  event.timer = number;
  agents_.tell(agv, event);
}

inline Timers::Timer* Timers::find(Slice& slice, std::uint32_t number) {
  for (Timer& timer : slice.timers) {
    if (timer.number == number) return &timer;
  }
  return nullptr;
}

[[gnu::noinline]] Timers::Timer* Timers::add(Slice& slice, std::uint32_t number) {
  return &slice.timers.emplace_back(Timer{number, 0});
}

}  // namespace fleetproof
