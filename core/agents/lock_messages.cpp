// What the lock protocol says, and when it says it again.
#include <algorithm>

#include "core/agents/lock_protocol.hpp"

namespace fleetproof::agents {
namespace {

// More than a third of the fleet gets one message together.
constexpr std::size_t kFewerMessages = 3;
// A STATE is sent at the latest after this time. It is longer in large fleets, so that an AGV hears about as many of
// them a second.
constexpr double kQuiet_s = 1.0, kQuietPerAgv_s = 0.05, kLongestQuiet_s = 30.0;

}  // namespace

// One message to all if it has enough addressees: it is one transmission.
void LockProtocol::ask() {
  if (to_ask_.size() * kFewerMessages <= neighbours_.fleet_count()) {
    for (const std::uint32_t agv : to_ask_) send_request(agv);
  } else {
    Message message = request_message();
    for (const std::uint32_t agv : to_ask_) {
      if (message.asked.add(entry_of(agv))) continue;
      send(message, FP_NONE);
      message.asked = {};
      message.asked.add(entry_of(agv));
    }
    send(message, FP_NONE);
  }
  to_ask_.clear();
}

// What a REQUEST says to this AGV.
Asked::Entry LockProtocol::entry_of(std::uint32_t agv) const {
  return {agv, static_cast<std::uint32_t>(neighbours_.of(agv).asked_epoch - epoch_)};
}

// Few repetitions go to their addressees, many go out with the STATE.
void LockProtocol::repeat() {
  look_at_all_ = true;
  due_.clear();
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    const bool request = options_.progress.asks_again && is_unanswered(n) && n.request_repeats.is_due();
    const bool answer = owes_answer(n) && (has_granted(n) || !n.knows_defer) && n.answer_repeats.is_due();
    if (request || answer) due_.push_back({agv, request, answer});
  });
  if (std::any_of(due_.begin(), due_.end(), [](const Due& due) { return due.request; }))
    controller_.sometimes("retransmission");
  const double quiet_s = static_cast<double>(controller_.now_ns() - state_sent_ns_) * 1e-9;
  if (due_.size() * kFewerMessages > neighbours_.fleet_count() || quiet_s > longest_quiet_s() || state_sent_ns_ < 0)
    return broadcast_state();
  for (const Due& due : due_) {
    const Neighbour& n = neighbours_.of(due.agv);
    if (due.request) send_request(due.agv);
    if (due.answer) send_answer(has_granted(n) ? MessageKind::Grant : MessageKind::Defer, due.agv, n.request_epoch);
  }
}

double LockProtocol::longest_quiet_s() const {
  return std::clamp(kQuietPerAgv_s * neighbours_.fleet_count(), kQuiet_s, kLongestQuiet_s);
}

void LockProtocol::broadcast_state() {
  state_sent_ns_ = controller_.now_ns();
  Message message;
  fill_in(message.status);
  // Others take the table as proof that the position is newer than what it acknowledges.
  if (position_at_ns_ == controller_.now_ns()) neighbours_.tell_heard_from(message.heard);
  if (requesting_) fill_in_request(message);
  fill_in_lists(message);
  send(message, FP_NONE);
}

// The next STATE begins with those that this one has no room for.
void LockProtocol::fill_in_lists(Message& message) {
  std::uint32_t left_out = FP_NONE;
  const auto say = [&](std::uint32_t agv, bool fits) {
    if (!fits && left_out == FP_NONE) left_out = agv;
  };
  neighbours_.for_each_from(first_in_lists_, [&](std::uint32_t agv, const Neighbour& n) {
    if (options_.progress.asks_again && is_unanswered(n)) say(agv, message.asked.add(entry_of(agv)));
    if (owes_answer(n)) say(agv, message.answers.add({agv, n.request_epoch, has_granted(n)}));
  });
  neighbours_.for_each_from(first_in_lists_, [&](std::uint32_t agv, const Neighbour& n) {
    const bool has_deferred = is_asked(n) && !has_consent(n) && n.deferred_us_epoch == n.asked_epoch;
    if (has_deferred) say(agv, message.asked.add(entry_of(agv), true));
  });
  if (left_out != FP_NONE) first_in_lists_ = left_out;
}

void LockProtocol::send_answer(MessageKind kind, std::uint32_t receiver, Epoch echo) {
  Message message;
  message.kind = kind;
  fill_in(message.status);
  message.echo = echo;
  send(message, receiver);
}

// To all AGVs if the receiver is FP_NONE.
void LockProtocol::send(const Message& message, std::uint32_t receiver) {
  controller_.describe(name_of(message.kind));
  if (receiver == FP_NONE) {
    controller_.broadcast(WireMessage(message).bytes());
  } else {
    controller_.send(WireMessage(message).bytes(), receiver);
  }
}

void LockProtocol::send_request(std::uint32_t receiver) {
  Message message = request_message();
  message.asked.add(entry_of(receiver));
  send(message, receiver);
}

Message LockProtocol::request_message() {
  Message message;
  message.kind = MessageKind::Request;
  fill_in(message.status);
  fill_in_request(message);
  return message;
}

void LockProtocol::fill_in_request(Message& message) {
  message.demand_ns = demand_ns_;
  message.request = request_;
}

void LockProtocol::fill_in(Status& status) {
  const std::int64_t now_ns = controller_.now_ns();
  fp_pose pose{};
  if (position_at_ns_ != now_ns && controller_.pose(pose)) {
    position_m_ = {pose.x_m, pose.y_m};
    position_at_ns_ = now_ns;
  }
  status.stamp_ms = Neighbours::stamp_ms(now_ns);
  status.position_m = position_m_;
  status.epoch = epoch_;
  status.requesting = requesting_;
  status.blocked = is_blocked();
  status.waiting = waiting_;
  status.idle = idle_;
  status.out_of_order = out_of_order_;
  status.held = held_;
}

}  // namespace fleetproof::agents
