// Messages: a transmission is an activity with an interval of its own, one reception per receiver in range.
#include "core/engine.hpp"

namespace fleetproof {

std::int32_t Engine::send(Agv& agv, std::string_view bytes, std::uint32_t receiver) {
  const bool broadcast = receiver == FP_NONE;
  if (bytes.size() > FP_MESSAGE_BYTES_MAX || (!broadcast && (receiver >= agvs_.size() || receiver == agv.id.value))) return FP_INVALID;
  const auto copies = broadcast ? static_cast<std::uint32_t>(agvs_.size()) : 2U;  // one more than receivers: held until it has been sent
  const std::uint32_t slot = messages_.add(agv.id, bytes, copies);
  if (takes_effect_now(agv)) {
    transmit(agv, slot, receiver);
  } else {
    take_effect_later(agv, {.kind = PendingCall::Kind::Send, .what = receiver, .message = slot});
  }
  return FP_OK;
}

void Engine::transmit(Agv& sender, std::uint32_t slot, std::uint32_t receiver) {
  if (sender.last_sent != now_) {
    sender.last_sent = now_;
    sender.sent_at_that_instant = 0;
  }
  const std::uint32_t ordinal = sender.sent_at_that_instant++;
  ++outcome_.counters.messages_sent;
  trace(sender.id, TraceKind::Sent, receiver, messages_[slot].hash);
  const Pose from = unlimited_range_ ? Pose{} : world_.pose_of(sender.id, now_);
  if (receiver != FP_NONE) {
    transmit_to(sender, AgvId{receiver}, slot, from, ordinal);
  } else {
    for (const Agv& other : agvs_) {
      if (other.id != sender.id) transmit_to(sender, other.id, slot, from, ordinal);
    }
  }
  messages_.release(slot);
}

void Engine::transmit_to(Agv& sender, AgvId receiver, std::uint32_t slot, const Pose& from, std::uint32_t ordinal) {
  if (!unlimited_range_ && (world_.pose_of(receiver, now_).position_m - from.position_m).norm() > scenario_.radio.range_m) {
    ++outcome_.counters.out_of_range;
    messages_.release(slot);
    return;
  }
  const Fate fate = radio_.fate(sender.id, receiver, now_, ordinal);
  ++outcome_.counters.receptions;
  outcome_.counters.delay_sum_ns += static_cast<std::uint64_t>(fate.delay.count());
  if (fate.lost) {
    ++outcome_.counters.receptions_lost;
    trace(receiver, TraceKind::Lost, sender.id.value, messages_[slot].hash);
    messages_.release(slot);
    return;
  }
  queue_.push(now_ + fate.delay, receiver, Event::Kind::MessageArrives, slot);
}

void Engine::message_arrives(Agv& receiver, std::uint32_t slot) {
  trace(receiver.id, TraceKind::Received, messages_[slot].sender.value, messages_[slot].hash);
  ++outcome_.counters.received;
  if (receiver.agent_failed || receiver.agent_away) return messages_.release(slot);
  const bool was_empty = receiver.inbox_read == receiver.inbox.size();
  receiver.inbox.push_back(slot);
  if (!was_empty && !receiver.waiting_events.empty()) return;  // it is going to look into its inbox anyway
  fp_event event{};
  event.kind = FP_EVENT_MESSAGE;
  tell(receiver, event);
}

std::int32_t Engine::read_message(Agv& agv, fp_message& out) {
  drop_message_in_hand(agv);
  if (agv.inbox_read == agv.inbox.size()) return FP_EMPTY;
  agv.message_in_hand = agv.inbox[agv.inbox_read++];
  if (agv.inbox_read == agv.inbox.size()) {
    agv.inbox.clear();
    agv.inbox_read = 0;
  }
  const Message& message = messages_[agv.message_in_hand];
  out.sender = message.sender.value;
  out.size = static_cast<std::uint32_t>(message.bytes.size());
  out.bytes = message.bytes.data();
  return FP_OK;
}

void Engine::drop_message_in_hand(Agv& agv) {
  if (agv.message_in_hand == FP_NONE) return;
  messages_.release(agv.message_in_hand);
  agv.message_in_hand = FP_NONE;
}

}  // namespace fleetproof
