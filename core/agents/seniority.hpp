#pragma once

#include <cstdint>

namespace fleetproof::agents {

// Since when an AGV has wanted to reach its next goal: among AGVs that block each other, the older demand goes first.
// An AGV that lets all others pass counts as young, so that it does not come back before they have passed. A while
// later its demand is as old as it was: an AGV that lets others pass again and again would never arrive.
class Seniority {
 public:
  // Negative: the AGV wants nothing.
  std::int64_t since_ns() const { return since_ns_; }

  // The AGV wants to go on.
  void raise(std::int64_t now_ns);
  // It has reached a goal.
  void meet() { since_ns_ = before_ns_ = kNone; }
  // It lets all others pass.
  void stand_back(std::int64_t now_ns);

  static constexpr std::int64_t kYoung_ns = 15'000'000'000;

 private:
  static constexpr std::int64_t kNone = -1;

  std::int64_t since_ns_ = kNone, before_ns_ = kNone;  // before it stood back
  std::int64_t old_again_at_ns_ = 0;
};

}  // namespace fleetproof::agents
