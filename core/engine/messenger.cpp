#include "core/engine/messenger.hpp"

#include <algorithm>
#include <utility>

namespace fleetproof {
namespace {

// A reception may have three events of one kind: the end of the air time (with interference), the arrival of the
// message, the arrival of its copy. Two bits of the payload distinguish them, because no run has 2^30 messages at a
// time.
constexpr std::uint32_t kAirTimeEnds = 0x80000000U, kCopy = 0x40000000U, kSlot = 0x3fffffffU;
static_assert(kLongestMessage_bytes == FP_MESSAGE_BYTES_MAX);

// Reception needs a range test only where the floor is larger than the range.
bool covers(const Box& floor, double range_m) { return range_m > (floor.high_m - floor.low_m).norm(); }

Box floor_of(const LogicalMap& map) {
  Box box;
  for (const Station& station : map.layout().stations) box.add(station.position_m);
  for (const Segment& segment : map.layout().segments) {
    for (const Vec2& point : segment.control_points_m) box.add(point);
  }
  return box;
}

TraceKind cause_of(const Fate& lost) {
  if (lost.to_source) return TraceKind::LostToSource;
  return lost.in_outage ? TraceKind::LostInOutage : TraceKind::Lost;
}

}  // namespace

Messenger::Messenger(RunContext& run, AgentHostPort agents)
    : run_(run),
      agents_(agents),
      radio_(run.scenario.radio, run.scenario.seed_of(Stream::Radio), run.scenario.fates, run.draw_numbers),
      channel_(run.scenario.radio, run.scenario.seed_of(Stream::Radio), run.draw_numbers),
      air_time_{0, run.scenario.radio.air_time(0)},
      unlimited_range_(covers(floor_of(*run.scenario.map), run.scenario.radio.range_m)),
      needs_places_(!unlimited_range_ || radio_.depends_on_place()),
      slices_(run.agvs.size()),
      sent_to_(run.agvs.size()),
      hearers_(run.agvs.size() + 3),
      draws_(run.agvs.size() + 3) {
  if (unlimited_range_) return;
  reach_.emplace(run.agvs.size(), run.scenario.radio.range_m, floor_of(*run.scenario.map));
  for (std::size_t i = 0; i < run.agvs.size(); ++i) reach_->piece_begins(run.world.body(AgvId{i}).piece);
}

// ---- sending

std::optional<std::uint32_t> Messenger::accept(AgvId sender, std::string_view bytes, std::uint32_t receiver) {
  const bool broadcast = receiver == FP_NONE;
  if (bytes.size() > FP_MESSAGE_BYTES_MAX || (!broadcast && (receiver >= slices_.size() || receiver == sender.value)))
    return std::nullopt;
  return pool_.add(sender, bytes, 1);  // it is held until it has been sent
}

void Messenger::transmit(AgvId sender, std::uint32_t slot, std::uint32_t receiver) {
  const std::uint32_t ordinal = slice_of(sender).sent.next(run_.now);
  ++run_.counters.messages_sent;
  const Message& message = pool_[slot];
  const std::size_t size = message.bytes.size();
  pool_.set_number(slot, static_cast<std::uint32_t>(run_.counters.messages_sent));
  run_.trace(sender, traced::Sent{AgvId{receiver}, message.hash, static_cast<std::uint32_t>(size), message.number},
             message.bytes);
  const Vec2 from_m = needs_places_ ? run_.pose_now(sender).position_m : Vec2::Zero();
  if (size != air_time_.bytes) air_time_ = {size, run_.scenario.radio.air_time(size)};
  const bool contended = run_.scenario.radio.contention.interference;
  pool_.goes_out(slot, contended ? channel_.contend(sender, run_.now, ordinal, air_time_.lasts)
                                 : AirInterval{run_.now, run_.now + air_time_.lasts});
  if (receiver == FP_NONE && unlimited_range_) {
    all_hear(sender, ordinal);
  } else {
    find_hearers(sender, ordinal, receiver, from_m);
  }
  const bool by_draws_alone = radio_.is_plain() && !contended && !message.spared && !run_.writer.has_sink();
  if (by_draws_alone && radio_.only_loses()) {
    deliver_together(sender, slot);
  } else {
    radio_.draw(sender, run_.now, {hearers_.data(), hearing_}, draws_.data());
    if (by_draws_alone) {
      deliver_plainly(slot);
    } else {
      for (std::size_t i = 0; i < hearing_; ++i) deliver(sender, i, slot, from_m);
    }
  }
  pool_.release(slot);
}

// Everybody but the sender, in ascending order. `ordinal`: the number of the message among those that its AGV sends at
// this instant, from 0 on.
void Messenger::all_hear(AgvId sender, std::uint32_t ordinal) {
  std::vector<std::uint32_t>& sent = sent_to_[sender.index()].counts;
  if (sent.empty()) [[unlikely]]
    sent.resize(slices_.size());
  if (ordinal == 0) std::ranges::fill(sent, 0);
  Hearer* hearer = hearers_.data();
  std::uint32_t* count = sent.data();
  for (std::uint32_t i = 0; i < sender.value; ++i) *hearer++ = {AgvId{i}, (*count++)++};
  ++count;
  for (std::uint32_t i = sender.value + 1; i < sent.size(); ++i) *hearer++ = {AgvId{i}, (*count++)++};
  hearing_ = sent.size() - 1;
}

void Messenger::find_hearers(AgvId sender, std::uint32_t ordinal, std::uint32_t receiver, const Vec2& from_m) {
  hearing_ = 0;
  SentTo& sent = sent_to_[sender.index()];
  if (sent.counts.empty() || (ordinal == 0 && unlimited_range_)) {
    sent.counts.assign(slices_.size(), 0);
  } else if (ordinal == 0) {
    for (const AgvId agv : sent.receivers) sent.counts[agv.index()] = 0;
  }
  if (ordinal == 0) sent.receivers.clear();
  if (receiver == FP_NONE) {
    find_hearers_in_range(sender, from_m);
  } else if (unlimited_range_ || is_in_range(AgvId{receiver}, from_m)) {
    hears(AgvId{receiver}, sent);
  } else {
    ++run_.counters.out_of_range;
  }
}

void Messenger::find_hearers_in_range(AgvId sender, const Vec2& from_m) {
  for (const std::uint32_t near : reach_->near(sender, from_m)) {
    const AgvId agv{near};
    if (agv != sender && is_in_range(agv, from_m)) hears(agv, sent_to_[sender.index()]);
  }
  run_.counters.out_of_range += slices_.size() - 1 - hearing_;
}

bool Messenger::is_in_range(AgvId receiver, const Vec2& from_m) const {
  return (run_.pose_now(receiver).position_m - from_m).norm() <= run_.scenario.radio.range_m;
}

// As deliver() for each hearer, if nothing but its draws decides its fate, nobody notes it, and all are equally late.
void Messenger::deliver_together(AgvId sender, std::uint32_t slot) {
  const Message& message = pool_[slot];
  const SimTime arrival = std::max(run_.now + radio_.delay({}), message.on_air.end);
  EventQueue::Arrival* const room = run_.queue.room_in_lane(arrival, hearing_);
  std::size_t arrives = 0;
  radio_.decide_losses(sender, run_.now, {hearers_.data(), hearing_}, [&](AgvId receiver, bool is_lost) {
    if (is_lost) {
      run_.trace(receiver, traced::Reception{TraceKind::Lost, sender, message.hash, message.number});
    } else if (room != nullptr) {
      room[arrives++] = run_.queue.arrival(arrival, receiver, slot);
    } else {
      run_.queue.push(arrival, receiver, Event::Kind::MessageArrives, slot);
      ++arrives;
    }
  });
  if (room != nullptr) run_.queue.stand_in_lane(arrives);
  run_.counters.delay_sum_ns += hearing_ * static_cast<std::uint64_t>((arrival - run_.now).count());
  count_receptions(slot, arrives);
}

// Likewise, but each has a delay of its own.
void Messenger::deliver_plainly(std::uint32_t slot) {
  const Message& message = pool_[slot];
  std::size_t arrives = 0;
  for (std::size_t i = 0; i < hearing_; ++i) {
    const SimTime arrival = std::max(run_.now + radio_.delay(draws_[i]), message.on_air.end);
    run_.counters.delay_sum_ns += static_cast<std::uint64_t>((arrival - run_.now).count());
    const AgvId receiver = hearers_[i].receiver;
    if (radio_.loses(draws_[i])) {
      run_.trace(receiver, traced::Reception{TraceKind::Lost, message.sender, message.hash, message.number});
    } else {
      run_.queue.push_arrivals(arrival, {&receiver, 1}, slot);
      ++arrives;
    }
  }
  count_receptions(slot, arrives);
}

void Messenger::count_receptions(std::uint32_t slot, std::size_t arriving) {
  run_.counters.receptions += hearing_;
  run_.counters.receptions_lost += hearing_ - arriving;
  pool_.hold(slot, static_cast<std::uint32_t>(arriving));
}

void Messenger::deliver(AgvId sender, std::size_t hearer, std::uint32_t slot, const Vec2& from_m) {
  const AgvId receiver = hearers_[hearer].receiver;
  Counters& counters = run_.counters;
  LinkPlaces places{from_m, {}};
  if (needs_places_) places.receiver_m = run_.pose_now(receiver).position_m;
  const Fate fate = radio_.fate(sender, hearers_[hearer], run_.now, draws_[hearer], places, pool_[slot].spared);
  const SimTime on_air_until = pool_[slot].on_air.end;
  const SimTime arrival = std::max(run_.now + fate.delay, on_air_until);
  ++counters.receptions;
  counters.delay_sum_ns += static_cast<std::uint64_t>((arrival - run_.now).count());
  if (run_.writer.has_sink()) note_fate(sender, hearers_[hearer], slot, fate);
  if (fate.lost) return lose(receiver, slot, cause_of(fate));
  if (run_.scenario.radio.contention.interference && !fate.given)
    run_.queue.push(on_air_until, receiver, Event::Kind::MessageArrives, slot | kAirTimeEnds);
  run_.queue.push_arrivals(arrival, {&receiver, 1}, slot);
  pool_.hold(slot, fate.copy_delay ? 2 : 1);
  if (fate.copy_delay) {
    run_.queue.push(std::max(run_.now + *fate.copy_delay, on_air_until), receiver, Event::Kind::MessageArrives,
                    slot | kCopy);
  }
}

void Messenger::note_fate(AgvId sender, const Hearer& hearer, std::uint32_t slot, const Fate& fate) {
  const auto& [receiver, ordinal] = hearer;
  const Duration least = pool_[slot].on_air.end - run_.now;
  traced::FateDecided decided{.sender = sender, .ordinal = ordinal, .lost = fate.lost, .number = pool_[slot].number};
  decided.due_after = std::max(fate.delay, least);
  run_.note(receiver, decided);
  if (fate.lost || !fate.copy_delay) return;
  decided.is_copy = true;
  decided.due_after = std::max(*fate.copy_delay, least);
  run_.note(receiver, decided);
}

void Messenger::lose(AgvId receiver, std::uint32_t slot, TraceKind cause) {
  Counters& counters = run_.counters;
  ++counters.receptions_lost;
  counters.lost_in_outage += cause == TraceKind::LostInOutage ? 1 : 0;
  counters.lost_to_sources += cause == TraceKind::LostToSource ? 1 : 0;
  run_.trace(receiver, traced::Reception{cause, pool_[slot].sender, pool_[slot].hash, pool_[slot].number});
}

// At the end of its air time a message is destroyed at this receiver, or nothing can happen to it any more.
[[gnu::noinline]] void Messenger::air_time_ends(AgvId receiver, std::uint32_t slot) {
  const Message& message = pool_[slot];
  if (!is_drowned(receiver, message)) return;
  ++run_.counters.receptions_lost;
  ++run_.counters.lost_by_interference;
  run_.trace(receiver, traced::Reception{TraceKind::LostByInterference, message.sender, message.hash, message.number});
  pool_.destroy_at(slot, receiver);
}

bool Messenger::is_drowned(AgvId receiver, const Message& message) const {
  return channel_.any_other_on_air(message.sender, message.on_air, [&](AgvId other) {
    if (other == receiver || unlimited_range_) return true;
    return (run_.pose_now(other).position_m - run_.pose_now(receiver).position_m).norm() <= run_.scenario.radio.range_m;
  });
}

// ---- receiving

[[gnu::flatten]] void Messenger::arrives(AgvId receiver, std::uint64_t payload) {
  const auto bits = static_cast<std::uint32_t>(payload);
  const std::uint32_t slot = bits & kSlot;
  if ((bits & kAirTimeEnds) != 0) return air_time_ends(receiver, slot);
  const Message& message = pool_[slot];
  if (message.is_destroyed_at(receiver)) return pool_.release(slot);
  if ((bits & kCopy) != 0) [[unlikely]] {
    ++run_.counters.duplicates;
    run_.writer.digest().mark_copy();
  }
  run_.trace(receiver, traced::Reception{TraceKind::Received, message.sender, message.hash, message.number});
  ++run_.counters.received;
  if (!agents_.is_up(receiver)) return pool_.release(slot);
  Inbox& inbox = slice_of(receiver).inbox;
  const bool had_unread = !inbox.empty();
  inbox.push(slot);
  if (had_unread && agents_.has_events_waiting(receiver)) return;  // the agent will read its inbox anyway
  fp_event event{};
  event.kind = FP_EVENT_MESSAGE;
  agents_.tell(receiver, std::move(event));
}

bool Messenger::read(AgvId agv, fp_message& out) {
  Slice& slice = slice_of(agv);
  put_down(slice);
  if (slice.inbox.empty()) return false;
  slice.in_hand = slice.inbox.take();
  const Message& message = pool_[slice.in_hand];
  out.sender = message.sender.value;
  out.size = static_cast<std::uint32_t>(message.bytes.size());
  out.bytes = message.bytes.data();
  return true;
}

void Messenger::put_down(Slice& slice) {
  if (slice.in_hand == FP_NONE) return;
  pool_.release(slice.in_hand);
  slice.in_hand = FP_NONE;
}

void Messenger::forget_inbox(AgvId agv) {
  Slice& slice = slice_of(agv);
  put_down(slice);
  for (const std::uint32_t slot : slice.inbox.unread()) pool_.release(slot);
  slice.inbox.clear();
}

}  // namespace fleetproof
