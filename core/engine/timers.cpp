#include "core/engine/timers.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof {

Timers::Timers(RunContext& run, AgentHostPort agents) : run_(run), agents_(agents) {
  for (const AgvSetup& agv : run.scenario.agvs) slices_.push_back({.clock = AgentClock(agv.sensing), .timers = {}});
}

void Timers::set(AgvId agv, std::uint32_t number, std::int64_t at_ns) {
  Slice& slice = slices_[agv.index()];
  auto timer = std::ranges::find(slice.timers, number, &Timer::number);
  if (timer == slice.timers.end()) timer = slice.timers.insert(timer, {number, 0});
  timer->stamp = at_ns < 0 ? 0 : ++slice.last_stamp;
  if (at_ns < 0) return;
  const SimTime at = std::max(run_.now, slice.clock.when_it_shows(at_ns));
  run_.queue.push(at, agv, Event::Kind::TimerGoesOff, number, timer->stamp);
}

void Timers::goes_off(AgvId agv, std::uint32_t number, std::uint64_t stamp) {
  auto& timers = slices_[agv.index()].timers;
  const auto timer = std::ranges::find(timers, number, &Timer::number);
  if (timer == timers.end() || timer->stamp != stamp) return;
  timer->stamp = 0;
  run_.trace(agv, traced::TimerWentOff{number});
  fp_event event{};
  event.kind = FP_EVENT_TIMER;
  event.timer = number;
  agents_.tell(agv, std::move(event));
}

}  // namespace fleetproof
