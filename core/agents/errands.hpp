#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/agents/controller.hpp"
#include "core/agents/section_planner.hpp"

namespace fleetproof::agents {

// What the AGV still has to do, in its order, and whose load is on board. Goals that a locked section reaches are no
// longer here.
class Errands {
 public:
  // `boot`: the boot of the computer.
  Errands(Controller& controller, std::uint32_t boot) : controller_(controller), boot_(boot) {}

  // A transport for this AGV. After a restart the load of one of them may be on board already.
  void take(const fp_event& order);
  // The load of this order does not wait where the order says: the order is done, or its load is lost.
  void forget(std::uint32_t order);
  // The transfer may have been the last action of the former self of a restarted agent.
  bool is_needless(const Leg& transfer);

  bool empty() const { return goals_.empty(); }
  std::span<const Goal> goals() const { return goals_; }
  // What is left to do before another load is picked: deliver the one on board, and charge.
  std::span<const Goal> of_the_load_on_board() const {
    const auto pick = std::ranges::find(goals_, Leg::Kind::Pick, &Goal::transfer);
    return goals().first(static_cast<std::size_t>(pick - goals_.begin()));
  }
  bool next_is(Leg::Kind transfer) const { return !goals_.empty() && goals_.front().transfer == transfer; }
  void reached(std::uint32_t count) { goals_.erase(goals_.begin(), goals_.begin() + count); }
  // Goes to this charger before everything else, instead of to another charger.
  void charge_at(std::uint32_t station);

 private:
  Controller& controller_;
  std::uint32_t boot_;
  bool order_seen_ = false;
  std::vector<Goal> goals_;
};

}  // namespace fleetproof::agents
