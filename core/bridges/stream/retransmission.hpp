// After which time a segment that is not acknowledged is sent again (RFC 6298).
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace fleetproof::stream {

inline constexpr std::int64_t kMillisecond_ns = 1'000'000, kSecond_ns = 1'000 * kMillisecond_ns;

struct TimeoutSettings {
  std::int64_t fixed_ns = 0;  // nothing is measured, and repeats do not wait longer; 0: as below
  std::int64_t first_ns = kSecond_ns, least_ns = 200 * kMillisecond_ns, most_ns = 60 * kSecond_ns;
};

class RetransmissionTimeout {
 public:
  explicit RetransmissionTimeout(const TimeoutSettings& settings)
      : settings_(settings), timeout_ns_(settings.fixed_ns > 0 ? settings.fixed_ns : settings.first_ns) {}

  std::int64_t ns() const { return timeout_ns_; }
  // The round trip of a segment that was sent once.
  void measured(std::int64_t round_trip_ns) {
    if (settings_.fixed_ns > 0) return;
    if (mean_ns_ < 0) {
      mean_ns_ = round_trip_ns;
      variation_ns_ = round_trip_ns / 2;
    } else {
      variation_ns_ += (std::abs(mean_ns_ - round_trip_ns) - variation_ns_) / 4;
      mean_ns_ += (round_trip_ns - mean_ns_) / 8;
    }
    measured_ns_ =
        std::clamp(mean_ns_ + std::max(kGranularity_ns, 4 * variation_ns_), settings_.least_ns, settings_.most_ns);
    timeout_ns_ = measured_ns_;
  }
  // Something new has arrived at the other end. No measure is of a repeat, so what is measured holds again.
  void answered() {
    if (measured_ns_ > 0) timeout_ns_ = measured_ns_;
  }
  // It was over: the next one is twice as long, until there is an answer.
  void expired() {
    if (settings_.fixed_ns == 0) timeout_ns_ = std::min(2 * timeout_ns_, settings_.most_ns);
  }

 private:
  static constexpr std::int64_t kGranularity_ns = 10 * kMillisecond_ns;  // of the clocks of usual stacks

  TimeoutSettings settings_;
  std::int64_t timeout_ns_;
  std::int64_t mean_ns_ = -1, variation_ns_ = 0;  // of round trips; below 0: none was measured
  std::int64_t measured_ns_ = 0;                  // the timeout that follows; 0: none was measured
};

}  // namespace fleetproof::stream
