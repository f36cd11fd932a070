#include "core/engine/messenger.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof {
namespace {

// A reception may have three events of one kind: the end of the air time (with interference), the arrival of the
// message, the arrival of its copy. Bits of the payload distinguish them, because no run has 2^28 messages at a time.
// The third bit says that other transmissions may have destroyed the message at its receiver, the fourth that it came
// by wire.
constexpr std::uint32_t kAirTimeEnds = 0x80000000U, kCopy = 0x40000000U, kContended = 0x20000000U,
                        kByWire = 0x10000000U, kSlot = 0x0fffffffU;
static_assert(kLongestMessage_bytes == FP_MESSAGE_BYTES_MAX);

TraceKind cause_of(const Delivery& lost) {
  if (lost.to_source) return TraceKind::LostToSource;
  return lost.in_outage ? TraceKind::LostInOutage : TraceKind::Lost;
}

// Where the two ends of a link are. A computer that is connected everywhere counts as being where the AGV is.
LinkPlaces places_of(const RunContext& run, EntityId sender, const std::optional<Vec2>& from_m, EntityId receiver) {
  const std::optional<Vec2> at_m = run.antenna_m(receiver);
  return {.sender_m = from_m ? *from_m : *at_m,
          .receiver_m = at_m ? *at_m : *from_m,
          .sender_roams = run.scenario.is_agv(sender),
          .receiver_roams = run.scenario.is_agv(receiver)};
}

}  // namespace

Messenger::Messenger(RunContext& run, AgentHostPort agents)
    : run_(run),
      agents_(agents),
      radio_(run.scenario.radio, run.scenario.seed_of(Stream::Radio), run.scenario.deliveries, run.draw_numbers),
      channel_(run.scenario.radio, run.scenario.seed_of(Stream::Radio), run.draw_numbers),
      hearers_(run),
      air_time_{0, run.scenario.radio.air_time(0)},
      contended_(run.scenario.radio.contention.interference),
      needs_places_(!hearers_.are_everybody() || radio_.depends_on_place()),
      draws_decide_(radio_.is_plain() && !contended_ && !run.writer.has_sink()),
      losses_decide_(draws_decide_ && radio_.only_loses()),
      others_(run.agvs.size() - 1),
      wire_{.takes = seconds(run.scenario.wire.takes_s)},
      agv_states_(run.scenario.participant_count()),
      draws_(run.scenario.participant_count() + 3) {}

// ---- sending

std::optional<std::uint32_t> Messenger::accept(AgvId sender, std::string_view bytes, std::uint32_t receiver) {
  const bool broadcast = receiver == FP_NONE;
  if (bytes.size() > FP_MESSAGE_BYTES_MAX ||
      (!broadcast && (receiver >= agv_states_.size() || receiver == sender.value)))
    return std::nullopt;
  return pool_.add(sender, bytes, 1);  // it is held until it has been sent
}

void Messenger::transmit(AgvId sender, std::uint32_t slot, std::uint32_t receiver) {
  const std::uint32_t ordinal = agv_state_of(sender).sent.next(run_.now);
  Message& message = pool_[slot];
  const std::size_t size = message.bytes.size();
  message.number = static_cast<std::uint32_t>(++run_.counters.messages_sent);
  run_.trace(sender, traced::Sent{AgvId{receiver}, message.hash, static_cast<std::uint32_t>(size), message.number},
             message.bytes);
  if (size != air_time_.bytes) air_time_ = {size, run_.scenario.radio.air_time(size)};
  message.on_air = contended_ && !run_.scenario.are_wired(sender, EntityId{receiver})
                       ? channel_.contend(sender, run_.now, ordinal, air_time_.lasts)
                       : AirInterval{run_.now, run_.now + air_time_.lasts};
  hearers_.begin(sender, ordinal);
  if (losses_decide_ && receiver == FP_NONE && hearers_.hear_alike(sender) && !message.spared) {
    const std::uint32_t number = hearers_.next_number(sender);
    if (!hearers_.are_everybody()) {
      deliver_in_range(slot, number);
    } else {
      deliver_together(slot, others_, [&](std::size_t i) {
        return Hearer{AgvId{i + (i >= sender.index() ? 1 : 0)}, number};
      });
    }
  } else {
    deliver_one_by_one(slot, receiver);
  }
  pool_.release(slot);
}

[[gnu::noinline]] void Messenger::deliver_in_range(std::uint32_t slot, std::uint32_t number) {
  const AgvId sender = pool_[slot].sender;
  const auto heard_by = hearers_.in_range(sender, run_.pose_now(sender).position_m);
  deliver_together(slot, heard_by.size(), [&](std::size_t i) { return Hearer{AgvId{heard_by.data()[i]}, number}; });
}

// Of a message that a computer sends. What is left over goes by radio: computers are the last of those who hear it. The
// receptions of a run are those of its radio.
std::span<const Hearer> Messenger::deliver_by_wire(std::uint32_t slot, std::span<const Hearer> hearers) {
  const auto is_agv = [&](const Hearer& hearer) { return run_.scenario.is_agv(hearer.receiver); };
  const auto by_radio = static_cast<std::size_t>(std::ranges::partition_point(hearers, is_agv) - hearers.begin());
  for (const auto& [receiver, ordinal] : hearers.subspan(by_radio)) {
    run_.queue.push_arrivals(run_.now + wire_.takes, {&receiver, 1}, slot | kByWire);
    ++pool_[slot].copies;
  }
  return hearers.first(by_radio);
}

// Not so simple a message: to one participant, or with deliveries of many kinds.
[[gnu::noinline]] void Messenger::deliver_one_by_one(std::uint32_t slot, std::uint32_t to) {
  const EntityId sender = pool_[slot].sender;
  const bool spared = pool_[slot].spared;
  const std::optional<Vec2> from_m = needs_places_ ? run_.antenna_m(sender) : Vec2::Zero();
  std::span<const Hearer> hearers = hearers_.of(sender, to, from_m);
  if (run_.scenario.is_computer(sender)) hearers = deliver_by_wire(slot, hearers);
  if (losses_decide_ && !spared)
    return deliver_together(slot, hearers.size(), [&](std::size_t i) { return hearers.data()[i]; });
  radio_.draw(sender, run_.now, hearers, draws_.data());
  if (draws_decide_ && !spared) return deliver_plainly(slot, hearers);
  for (std::size_t i = 0; i < hearers.size(); ++i) deliver(hearers[i], draws_[i], slot, from_m);
}

// As deliver() for each hearer, if nothing but its draws decides its delivery, nobody notes it, and all are equally
// late.
template <class HearerAt>
void Messenger::deliver_together(std::uint32_t slot, std::size_t hearing, HearerAt hearer_at) {
  Message& message = pool_[slot];
  const SimTime arrival = std::max(run_.now + radio_.delay({}), message.on_air.end);
  EventQueue::Arrival* const room = run_.queue.room_in_lane(arrival, hearing);
  std::size_t arrives = 0;
  radio_.decide_losses(message.sender, run_.now, hearing, hearer_at, [&](AgvId receiver, bool is_lost) {
    if (is_lost) {
      run_.trace(receiver, traced::Reception{TraceKind::Lost, message.sender, message.hash, message.number});
    } else if (room != nullptr) {
      room[arrives++] = run_.queue.arrival(arrival, receiver, slot);
    } else {
      run_.queue.push(arrival, receiver, Event::Kind::MessageArrives, slot);
      ++arrives;
    }
  });
  if (room != nullptr) run_.queue.stand_in_lane(arrives);
  run_.counters.delay_sum_ns += hearing * static_cast<std::uint64_t>((arrival - run_.now).count());
  count_receptions(message, hearing, arrives);
}

// The same, but each has a delay of its own.
void Messenger::deliver_plainly(std::uint32_t slot, std::span<const Hearer> hearers) {
  Message& message = pool_[slot];
  std::size_t arrives = 0;
  for (std::size_t i = 0; i < hearers.size(); ++i) {
    const SimTime arrival = std::max(run_.now + radio_.delay(draws_[i]), message.on_air.end);
    run_.counters.delay_sum_ns += static_cast<std::uint64_t>((arrival - run_.now).count());
    const AgvId receiver = hearers[i].receiver;
    if (radio_.loses(draws_[i])) {
      run_.trace(receiver, traced::Reception{TraceKind::Lost, message.sender, message.hash, message.number});
    } else {
      run_.queue.push_arrivals(arrival, {&receiver, 1}, slot);
      ++arrives;
    }
  }
  count_receptions(message, hearers.size(), arrives);
}

void Messenger::count_receptions(Message& message, std::size_t hearing, std::size_t arriving) {
  run_.counters.receptions += hearing;
  run_.counters.receptions_lost += hearing - arriving;
  message.copies += static_cast<std::uint32_t>(arriving);
}

void Messenger::deliver(const Hearer& hearer, const Block& draws, std::uint32_t slot,
                        const std::optional<Vec2>& from_m) {
  const EntityId receiver = hearer.receiver;
  Message& message = pool_[slot];
  Counters& counters = run_.counters;
  const LinkPlaces places = needs_places_ ? places_of(run_, message.sender, from_m, receiver) : LinkPlaces{};
  const Delivery delivery = radio_.delivery(message.sender, hearer, run_.now, draws, places, message.spared);
  const SimTime on_air_until = message.on_air.end;
  const SimTime arrival = std::max(run_.now + delivery.delay, on_air_until);
  ++counters.receptions;
  counters.delay_sum_ns += static_cast<std::uint64_t>((arrival - run_.now).count());
  if (run_.writer.has_sink()) note_delivery(hearer, message, delivery);
  if (delivery.lost) return lose(receiver, message, cause_of(delivery));
  std::uint32_t arriving = slot;
  if (contended_ && !delivery.given) {
    run_.queue.push(on_air_until, receiver, Event::Kind::MessageArrives, slot | kAirTimeEnds);
    arriving |= kContended;
  }
  run_.queue.push_arrivals(arrival, {&receiver, 1}, arriving);
  message.copies += delivery.copy_delay ? 2 : 1;
  if (delivery.copy_delay) {
    run_.queue.push(std::max(run_.now + *delivery.copy_delay, on_air_until), receiver, Event::Kind::MessageArrives,
                    arriving | kCopy);
  }
}

void Messenger::note_delivery(const Hearer& hearer, const Message& message, const Delivery& delivery) {
  const auto& [receiver, ordinal] = hearer;
  const Duration least = message.on_air.end - run_.now;
  traced::DeliveryDecided decided{
      .sender = message.sender, .ordinal = ordinal, .lost = delivery.lost, .number = message.number};
  decided.due_after = std::max(delivery.delay, least);
  run_.note(receiver, decided);
  if (delivery.lost || !delivery.copy_delay) return;
  decided.is_copy = true;
  decided.due_after = std::max(*delivery.copy_delay, least);
  run_.note(receiver, decided);
}

void Messenger::lose(AgvId receiver, const Message& message, TraceKind cause) {
  Counters& counters = run_.counters;
  ++counters.receptions_lost;
  counters.lost_in_outage += cause == TraceKind::LostInOutage ? 1 : 0;
  counters.lost_to_sources += cause == TraceKind::LostToSource ? 1 : 0;
  run_.trace(receiver, traced::Reception{cause, message.sender, message.hash, message.number});
}

// What is not simply the arrival of a message. False: nothing arrives.
[[gnu::noinline]] bool Messenger::is_heard(AgvId receiver, std::uint32_t bits) {
  const std::uint32_t slot = bits & kSlot;
  if ((bits & kAirTimeEnds) != 0) {
    air_time_ends(receiver, slot);
    return false;
  }
  if ((bits & kByWire) != 0) ++wire_.received;
  if (pool_.is_destroyed_at(slot, receiver)) {
    pool_.release(slot);
    return false;
  }
  if ((bits & kCopy) != 0) {
    ++run_.counters.duplicates;
    run_.writer.digest().mark_copy();
  }
  return true;
}

// At the end of its air time a message is destroyed at this receiver, or nothing can happen to it any more.
void Messenger::air_time_ends(AgvId receiver, std::uint32_t slot) {
  const Message& message = pool_[slot];
  if (!is_drowned(receiver, message)) return;
  ++run_.counters.receptions_lost;
  ++run_.counters.lost_by_interference;
  run_.trace(receiver, traced::Reception{TraceKind::LostByInterference, message.sender, message.hash, message.number});
  pool_.destroy_at(slot, receiver);
}

bool Messenger::is_drowned(AgvId receiver, const Message& message) const {
  return channel_.any_other_on_air(message.sender, message.on_air, [&](AgvId other) {
    if (other == receiver || hearers_.are_everybody()) return true;
    return hearers_.is_in_range(receiver, run_.antenna_m(other));
  });
}

// ---- receiving

void Messenger::arrives(AgvId receiver, std::uint64_t payload) {
  const auto bits = static_cast<std::uint32_t>(payload);
  const std::uint32_t slot = bits & kSlot;
  if (bits != slot && !is_heard(receiver, bits)) [[unlikely]]
    return;
  const Message& message = pool_[slot];
  run_.trace(receiver, traced::Reception{TraceKind::Received, message.sender, message.hash, message.number});
  ++run_.counters.received;
  if (!agents_.is_up(receiver)) return pool_.release(slot);
  Inbox& inbox = agv_state_of(receiver).inbox;
  const bool had_unread = !inbox.empty();
  inbox.push(slot);
  if (had_unread && agents_.has_events_waiting(receiver)) return;  // the agent will read its inbox anyway
  fp_event event{};
  event.kind = FP_EVENT_MESSAGE;
  agents_.tell(receiver, event);
}

bool Messenger::read(AgvId agv, fp_message& out) {
  AgvState& agv_state = agv_state_of(agv);
  put_down(agv_state);
  if (agv_state.inbox.empty()) return false;
  agv_state.in_hand = agv_state.inbox.take();
  const Message& message = pool_[agv_state.in_hand];
  out.sender = message.sender.value;
  out.size = static_cast<std::uint32_t>(message.bytes.size());
  out.bytes = message.bytes.data();
  return true;
}

[[gnu::noinline]] std::span<const fp_message> Messenger::unread(AgvId agv) {
  unread_.clear();
  for (const std::uint32_t slot : agv_state_of(agv).inbox.unread()) {
    const Message& message = pool_[slot];
    unread_.push_back({sizeof(fp_message), message.sender.value, static_cast<std::uint32_t>(message.bytes.size()),
                       message.bytes.data()});
  }
  return unread_;
}

void Messenger::put_down(AgvState& agv_state) {
  if (agv_state.in_hand == FP_NONE) return;
  pool_.release(agv_state.in_hand);
  agv_state.in_hand = FP_NONE;
}

void Messenger::forget_inbox(AgvId agv) {
  AgvState& agv_state = agv_state_of(agv);
  put_down(agv_state);
  for (const std::uint32_t slot : agv_state.inbox.unread()) pool_.release(slot);
  agv_state.inbox.clear();
}

void Messenger::settle_accounts() {
  run_.counters.received -= std::exchange(wire_.received, 0U);
  for (const std::size_t i : radio_.unused_deliveries())
    run_.deny(run_.scenario.deliveries[i].sender, Denial::NotSent, i);
}

}  // namespace fleetproof
