#include "core/agents/errands.hpp"

namespace fleetproof::agents {

// A host of an older minor version does not say whose load is on board; it is that of the first order.
void Errands::take(const fp_event& order) {
  const std::uint32_t on_board = controller_.order_on_board();
  const bool first_on_board = on_board == FP_NONE && !order_seen_ && controller_.loaded();
  order_seen_ = true;
  if (boot_ == 0 || (on_board != order.order_id && !first_on_board))
    goals_.push_back({order.from, Leg::Kind::Pick, order.order_id});
  goals_.push_back({order.to, Leg::Kind::Drop, order.order_id});
}

void Errands::forget(std::uint32_t order) {
  std::erase_if(goals_, [&](const Goal& goal) { return goal.order == order; });
}

bool Errands::is_needless(const Leg& transfer) {
  const std::uint32_t on_board = controller_.order_on_board();
  if (transfer.kind == Leg::Kind::Pick) return on_board == transfer.order && on_board != FP_NONE;
  if (transfer.kind != Leg::Kind::Drop) return false;
  return !controller_.loaded() || (on_board != FP_NONE && on_board != transfer.order);
}

void Errands::charge_at(std::uint32_t station) {
  if (next_is(Leg::Kind::Charge)) goals_.erase(goals_.begin());
  goals_.insert(goals_.begin(), {station, Leg::Kind::Charge, FP_NONE});
}

}  // namespace fleetproof::agents
