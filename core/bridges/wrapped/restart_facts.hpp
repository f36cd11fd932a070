#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "core/sdk/fleetproof/agent.h"

namespace fleetproof::wrapped {

// What a program that begins again has to be told, from what it has heard and done: where the AGV is, and the
// transports that are not done.
class RestartFacts {
 public:
  explicit RestartFacts(const fp_briefing& briefing);

  // Every event that the program hears, with what the AGV perceives before it does.
  void hear(const fp_event& event, const fp_perceived& seen);
  void accepted(std::uint32_t segment) { actions_.push_back(segment); }
  void works_on(std::uint32_t agv, std::uint32_t order);
  // The briefing of the program that begins now. Valid until the next call.
  const fp_briefing& briefing_now(const fp_perceived& seen);
  // The orders of which it is told again: first that of the load on board, then the oldest first.
  std::vector<fp_event> orders_now(const fp_perceived& seen) const;

 private:
  struct Order {
    fp_event told;
    bool is_done = false;
  };
  std::uint32_t end_of(std::uint32_t segment) const;
  Order* order(std::uint32_t id);
  void put_down(std::uint32_t id);

  fp_briefing briefing_;
  std::uint32_t station_, on_board_ = FP_NONE;
  std::deque<std::uint32_t> actions_;  // segments of those that are accepted and have not ended
  std::vector<Order> orders_;          // oldest first
  std::vector<std::uint32_t> work_;    // by AGV: the order on which the program says that it works
};

}  // namespace fleetproof::wrapped
