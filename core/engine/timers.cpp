#include "core/engine/timers.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

constexpr std::int64_t kBillion = 1'000'000'000;

}  // namespace

AgentClock::AgentClock(const SensingSetup& setup)
    : offset_ns_(seconds(setup.clock_offset_s).count()),
      drift_ppb_(static_cast<std::int64_t>(std::nearbyint(setup.clock_drift_ppm * 1000.0))) {}

// Whole seconds and the rest are multiplied separately, so that no product exceeds 64 bits.
std::int64_t AgentClock::shows_with_drift_ns(SimTime t) const {
  const std::int64_t ns = to_ns(t);
  return ns + offset_ns_ + ns / kBillion * drift_ppb_ + ns % kBillion * drift_ppb_ / kBillion;
}

SimTime AgentClock::when_it_shows_with_drift(std::int64_t ns) const {
  // A quotient that is a few nanoseconds off, and then around it until the instant lies between.
  const double rate = 1.0 + static_cast<double>(drift_ppb_) / static_cast<double>(kBillion);
  const auto guess = static_cast<std::int64_t>(static_cast<double>(ns - offset_ns_) / rate);
  const auto within = [](std::int64_t instant_ns) {
    return std::clamp<std::int64_t>(instant_ns, -1, kLongestDuration.count() / 2);
  };
  std::int64_t low = within(guess - 1), high = std::max(within(guess + 1), low + 1);
  for (std::int64_t step = 2; low >= 0 && shows_ns(at_ns(low)) >= ns; step *= 2) low = within(low - step);
  for (std::int64_t step = 2; shows_ns(at_ns(high)) < ns && high < kLongestDuration.count() / 2; step *= 2)
    high = within(high + step);
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (shows_ns(at_ns(middle)) >= ns ? high : low) = middle;
  }
  return at_ns(high);
}

Timers::Timers(RunContext& run, AgentHostPort agents) : run_(run), agents_(agents) {
  agv_states_.reserve(run.scenario.participant_count());
  for (const AgvSetup& agv : run.scenario.agvs) agv_states_.push_back({.clock = AgentClock(agv.sensing), .timers = {}});
  for (const ComputerSetup& computer : run.scenario.computers) {
    const SensingSetup clock{.clock_offset_s = computer.clock_offset_s, .clock_drift_ppm = computer.clock_drift_ppm};
    agv_states_.push_back({.clock = AgentClock(clock), .timers = {}});
  }
}

void Timers::set(AgvId agv, std::uint32_t number, std::int64_t at_ns) {
  AgvState& agv_state = agv_states_[agv.index()];
  Timer* timer = find(agv_state, number);
  if (timer == nullptr) [[unlikely]]
    timer = add(agv_state, number);
  timer->stamp = at_ns < 0 ? 0 : ++agv_state.last_stamp;
  if (at_ns < 0) return;
  run_.queue.push_timer(std::max(run_.now, agv_state.clock.when_it_shows(at_ns)), agv, number, timer->stamp);
}

void Timers::goes_off(AgvId agv, std::uint32_t number, std::uint64_t stamp) {
  Timer* const timer = find(agv_states_[agv.index()], number);
  if (timer == nullptr || timer->stamp != stamp) return;
  timer->stamp = 0;
  run_.trace(agv, traced::TimerWentOff{number});
  fp_event event{};
  event.kind = FP_EVENT_TIMER;
  event.timer = number;
  agents_.tell(agv, event);
}

inline Timers::Timer* Timers::find(AgvState& agv_state, std::uint32_t number) {
  for (Timer& timer : agv_state.timers) {
    if (timer.number == number) return &timer;
  }
  return nullptr;
}

[[gnu::noinline]] Timers::Timer* Timers::add(AgvState& agv_state, std::uint32_t number) {
  return &agv_state.timers.emplace_back(Timer{number, 0});
}

}  // namespace fleetproof
