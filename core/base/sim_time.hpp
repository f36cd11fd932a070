#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace fleetproof {

// Simulated time: whole nanoseconds since the start of the run. It is independent of any wall clock.
struct SimClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::duration<rep, period>;
  using time_point = std::chrono::time_point<SimClock>;
  static constexpr bool is_steady = true;
};

using Duration = SimClock::duration;
using SimTime = SimClock::time_point;

inline constexpr SimTime kStart{};
inline constexpr SimTime kForever = SimTime::max();

// Rounds to the nearest nanosecond: 25/6 m at the accelerations of the paper takes 5 s exactly. A value that no run can
// reach, or that is not a number, becomes kLongestDuration: about 146 years. Sums of a few such values stay in range.
inline constexpr Duration kLongestDuration{std::int64_t{1} << 62};
inline Duration seconds(double value_s) {
  const double ns = std::nearbyint(value_s * 1e9);
  if (!(ns < static_cast<double>(kLongestDuration.count()))) return kLongestDuration;
  return Duration{ns > -static_cast<double>(kLongestDuration.count()) ? static_cast<std::int64_t>(ns)
                                                                      : -kLongestDuration.count()};
}

// Divided, not multiplied: the quotient is the double nearest to the decimal number, so that 12.345 s prints as such.
constexpr double to_seconds(Duration d) { return static_cast<double>(d.count()) / 1e9; }
constexpr double to_seconds(SimTime t) { return to_seconds(t.time_since_epoch()); }
constexpr std::int64_t to_ns(SimTime t) { return t.time_since_epoch().count(); }
constexpr SimTime at_ns(std::int64_t ns) { return SimTime{Duration{ns}}; }

}  // namespace fleetproof
