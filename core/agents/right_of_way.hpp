#pragma once

#include <cstdint>

#include "core/agents/controller.hpp"
#include "core/agents/lock_options.hpp"
#include "core/agents/neighbours.hpp"

namespace fleetproof::agents {

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
  // The AGV has locked a stretch: its patience begins anew.
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
