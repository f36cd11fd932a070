#pragma once

#include <cstdint>

#include "core/base/sim_time.hpp"

namespace fleetproof {

// Counts how often one agent is called.
class ActivationCount {
 public:
  static constexpr std::uint32_t kMostAtInstant = 10'000;  // without time advancing

  // Counts an activation. False: it is one too many. `most`: in the run.
  bool admit(SimTime now, std::uint64_t most) {
    if (now == last_) [[unlikely]] {
      if (++at_instant_ > kMostAtInstant) return false;
    } else {
      last_ = now;
      at_instant_ = 1;
    }
    return ++in_run_ <= most;
  }
  // After one too many: which limit it broke, in words.
  const char* broken_limit() const {
    return at_instant_ > kMostAtInstant ? "10 000 activations without time advancing"
                                        : "woke up more often than any control software needs";
  }

 private:
  SimTime last_ = SimTime::min();
  std::uint32_t at_instant_ = 0;
  std::uint64_t in_run_ = 0;
};

}  // namespace fleetproof
