// Messages: a transmission is an activity with an interval of its own, one reception per receiver in range.
#include <algorithm>

#include "core/engine/engine.hpp"

namespace fleetproof {
namespace {

// A reception may have three events of one kind; two bits of the payload tell them apart (no run has 2^30 messages at a
// time): with interference the end of the air time, the arrival of the message, the arrival of its copy.
constexpr std::uint32_t kAirTimeEnds = 0x80000000U, kCopy = 0x40000000U, kSlot = 0x3fffffffU;
static_assert(kLongestMessage_bytes == FP_MESSAGE_BYTES_MAX);

}  // namespace

std::int32_t Engine::send(Agv& agv, std::string_view bytes, std::uint32_t receiver) {
  const bool broadcast = receiver == FP_NONE;
  if (bytes.size() > FP_MESSAGE_BYTES_MAX || (!broadcast && (receiver >= agvs_.size() || receiver == agv.id.value)))
    return FP_INVALID;
  const auto copies = broadcast ? static_cast<std::uint32_t>(agvs_.size())
                                : 2U;  // one more than receivers: held until it has been sent
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
  const std::string& bytes = messages_[slot].bytes;
  trace(sender.id, TraceKind::Sent, receiver, messages_[slot].hash, {}, static_cast<std::uint32_t>(bytes.size()));
  const bool needs_place = !unlimited_range_ || radio_.depends_on_place();
  const Pose from = needs_place ? world_.pose_of(sender.id, now_) : Pose{};
  const Duration air_time = scenario_.radio.air_time(bytes.size());
  const bool contended = scenario_.radio.contention.interference;
  messages_.goes_out(
      slot, contended ? channel_.contend(sender.id, now_, ordinal, air_time) : AirInterval{now_, now_ + air_time});
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
  Counters& counters = outcome_.counters;
  LinkPlaces places{from.position_m, {}};
  if (!unlimited_range_ || radio_.depends_on_place()) places.receiver_m = world_.pose_of(receiver, now_).position_m;
  if (!unlimited_range_ && (places.receiver_m - places.sender_m).norm() > scenario_.radio.range_m) {
    ++counters.out_of_range;
    messages_.release(slot);
    return;
  }
  const Fate fate = radio_.fate(sender.id, receiver, now_, ordinal, places);
  const SimTime on_air_until = messages_[slot].on_air.end;
  const SimTime arrival = std::max(now_ + fate.delay, on_air_until);
  ++counters.receptions;
  counters.delay_sum_ns += static_cast<std::uint64_t>((arrival - now_).count());
  if (fate.lost) {
    ++counters.receptions_lost;
    const TraceKind cause = fate.to_source   ? TraceKind::LostToSource
                            : fate.in_outage ? TraceKind::LostInOutage
                                             : TraceKind::Lost;
    counters.lost_in_outage += cause == TraceKind::LostInOutage ? 1 : 0;
    counters.lost_to_sources += cause == TraceKind::LostToSource ? 1 : 0;
    trace(receiver, cause, sender.id.value, messages_[slot].hash);
    messages_.release(slot);
    return;
  }
  if (scenario_.radio.contention.interference)
    queue_.push(on_air_until, receiver, Event::Kind::MessageArrives, slot | kAirTimeEnds);
  queue_.push(arrival, receiver, Event::Kind::MessageArrives, slot);
  if (fate.copy_delay) {
    messages_.hold(slot);
    queue_.push(std::max(now_ + *fate.copy_delay, on_air_until), receiver, Event::Kind::MessageArrives, slot | kCopy);
  }
}

// At the end of its air time a message is destroyed at this receiver, or nothing can happen to it any more.
void Engine::air_time_ends(Agv& receiver, std::uint32_t slot) {
  const Message& message = messages_[slot];
  if (!is_drowned(receiver.id, message)) return;
  ++outcome_.counters.receptions_lost;
  ++outcome_.counters.lost_by_interference;
  trace(receiver.id, TraceKind::LostByInterference, message.sender.value, message.hash);
  messages_.destroy_at(slot, receiver.id);
}

bool Engine::is_drowned(AgvId receiver, const Message& message) const {
  return channel_.any_other_on_air(message.sender, message.on_air, [&](AgvId other) {
    if (other == receiver || unlimited_range_) return true;
    return (world_.pose_of(other, now_).position_m - world_.pose_of(receiver, now_).position_m).norm() <=
           scenario_.radio.range_m;
  });
}

void Engine::message_arrives(Agv& receiver, std::uint32_t payload) {
  const std::uint32_t slot = payload & kSlot;
  if ((payload & kAirTimeEnds) != 0) return air_time_ends(receiver, slot);
  if (messages_[slot].is_destroyed_at(receiver.id)) return messages_.release(slot);
  if ((payload & kCopy) != 0) ++outcome_.counters.duplicates;
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
