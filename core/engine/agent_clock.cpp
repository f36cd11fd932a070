#include "core/engine/agent_clock.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

constexpr std::int64_t kBillion = 1'000'000'000;

}  // namespace

AgentClock::AgentClock(const SensingSetup& setup)
    : offset_ns_(seconds(setup.clock_offset_s).count()),
      drift_ppb_(static_cast<std::int64_t>(std::nearbyint(setup.clock_drift_ppm * 1000.0))) {}

// Whole seconds and the rest are multiplied separately, so that no product exceeds 64 bits.
std::int64_t AgentClock::shows_ns(SimTime t) const {
  const std::int64_t ns = to_ns(t);
  if (drift_ppb_ == 0) return ns + offset_ns_;
  return ns + offset_ns_ + ns / kBillion * drift_ppb_ + ns % kBillion * drift_ppb_ / kBillion;
}

SimTime AgentClock::when_it_shows(std::int64_t ns) const {
  ns = std::min(ns, kLongestDuration.count());  // an agent may ask for the end of time
  if (drift_ppb_ == 0) return at_ns(std::max<std::int64_t>(0, ns - offset_ns_));
  std::int64_t low = -1, high = std::max<std::int64_t>(1, std::min(ns, kLongestDuration.count() / 2));
  while (shows_ns(at_ns(high)) < ns && high < kLongestDuration.count() / 2) high *= 2;
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (shows_ns(at_ns(middle)) >= ns ? high : low) = middle;
  }
  return at_ns(high);
}

}  // namespace fleetproof
