// Which of the AGVs goes first that stand and block each other.
#pragma once

#include <cstdint>

#include "core/agents/controller.hpp"
#include "core/agents/lock_options.hpp"
#include "core/agents/neighbours.hpp"

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

// To which requests an AGV gives way that stands where they lead.
enum class Yields : std::uint8_t { ToNobody, ToElders, ToAll };

// If AGVs stand and block each other: which of them goes first. The demand is the instant since which an AGV has wanted
// to reach its next goal; the older demand goes first, then the smaller number. This order is the same for all AGVs.
// Wrong knowledge about other AGVs costs time here, never safety.
class RightOfWay {
 public:
  RightOfWay(Neighbours& neighbours, Controller& controller, const ProgressOptions& options = {})
      : neighbours_(neighbours), controller_(controller), smaller_number_first_(options.smaller_number_first) {}

  // Call this again and again while another waiting AGV blocks the own request. An AGV yields to older demands after a
  // few seconds. If it still stands there much later, the older demands cannot get on without its help, because they
  // themselves are in the way of younger ones: then it yields to all.
  Yields when_blocked(const OwnPath& held, std::int64_t demand_ns);
  // The AGV has locked a section: its patience begins anew.
  void got_on() { blocked_since_s_ = -1.0; }

  // Whether another AGV requests floor that this AGV holds.
  bool is_asked_for(const OwnPath& held);
  // Of this AGV's demand and the demands in whose way it is: the oldest. An AGV that leaves a place for an older demand
  // requests its way out with the age of that demand, so that others make way in turn.
  std::int64_t eldest_demand_ns(const OwnPath& held, std::int64_t demand_ns);
  // Whether an AGV that yields must keep clear of the request of `agv`.
  bool goes_first(Yields to, std::int64_t demand_ns, std::uint32_t agv, const Neighbour& neighbour) const;

 private:
  bool in_the_way(const OwnPath& held, std::int64_t demand_ns, Yields to);

  Neighbours& neighbours_;
  Controller& controller_;
  bool smaller_number_first_;
  double blocked_since_s_ = -1.0, patience_s_ = 0.0;
};

}  // namespace fleetproof::agents
