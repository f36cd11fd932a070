#include "core/agents/transmitter.hpp"

#include <algorithm>

#include "core/agents/message_text.hpp"
#include "core/agents/neighbours.hpp"

namespace fleetproof::agents {

void Transmitter::describe(bool waiting, bool idle, bool out_of_order) {
  waiting_ = waiting;
  idle_ = idle;
  out_of_order_ = out_of_order;
}

void Transmitter::fill_in(Status& status) {
  const std::int64_t now_ns = controller_.now_ns();
  fp_pose pose{};
  if (position_at_ns_ != now_ns && controller_.pose(pose)) {
    position_m_ = {pose.x_m, pose.y_m};
    position_at_ns_ = now_ns;
  }
  status.stamp_ms = stamp_ms_ = std::max(stamp_ms_, stamp_ms_at(now_ns));
  status.position_m = position_m_;
  status.position_is_new = position_at_ns_ == now_ns;
  status.waiting = waiting_;
  status.idle = idle_;
  status.out_of_order = out_of_order_;
}

std::uint32_t Transmitter::begin_new_stamp() {
  stamp_ms_ = std::max(stamp_ms_ + 1, stamp_ms_at(controller_.now_ns()));
  if (first_unused_ms_ == 0) first_unused_ms_ = stamp_ms_ + (boot_ > 0 ? Neighbours::kStampsAhead_ms : 0);
  return std::max(stamp_ms_, first_unused_ms_);
}

void Transmitter::send(const Message& message, std::uint32_t receiver) {
  const RequestNames requests(message, self_, receiver);
  controller_.describe(MessageText(message, map_).c_str(), requests.asks(), requests.answers());
  if (receiver == FP_NONE) {
    controller_.broadcast(WireMessage(message).bytes());
  } else {
    controller_.send(WireMessage(message).bytes(), receiver);
  }
}

}  // namespace fleetproof::agents
