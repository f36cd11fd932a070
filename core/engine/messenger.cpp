#include "core/engine/messenger.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

// A reception may have three events of one kind: the end of the air time (with interference), the arrival of the
// message, the arrival of its copy. Two bits of the payload distinguish them, because no run has 2^30 messages at a
// time.
constexpr std::uint32_t kAirTimeEnds = 0x80000000U, kCopy = 0x40000000U, kSlot = 0x3fffffffU;
static_assert(kLongestMessage_bytes == FP_MESSAGE_BYTES_MAX);

// Reception needs a range test only where the floor is larger than the range.
bool covers_floor(const RadioSetup& radio, const LogicalMap& map) {
  Box box;
  for (const Station& station : map.layout().stations) box.add(station.position_m);
  for (const Segment& segment : map.layout().segments) {
    for (const Vec2& point : segment.control_points_m) box.add(point);
  }
  return radio.range_m > (box.high_m - box.low_m).norm();
}

}  // namespace

Messenger::Messenger(RunContext& run, AgentHostPort agents)
    : run_(run),
      agents_(agents),
      radio_(run.scenario.radio, run.scenario.seed_of(Stream::Radio), run.scenario.fates, run.draw_numbers),
      channel_(run.scenario.radio, run.scenario.seed_of(Stream::Radio), run.draw_numbers),
      unlimited_range_(covers_floor(run.scenario.radio, *run.scenario.map)),
      needs_places_(!unlimited_range_ || radio_.depends_on_place()),
      slices_(run.agvs.size()),
      links_(run.agvs.size() * run.agvs.size()) {}

// ---- sending

std::optional<std::uint32_t> Messenger::accept(AgvId sender, std::string_view bytes, std::uint32_t receiver) {
  const bool broadcast = receiver == FP_NONE;
  if (bytes.size() > FP_MESSAGE_BYTES_MAX || (!broadcast && (receiver >= slices_.size() || receiver == sender.value)))
    return std::nullopt;
  // One copy more than receivers: the message is held until it has been sent.
  return pool_.add(sender, bytes, broadcast ? static_cast<std::uint32_t>(slices_.size()) : 2U);
}

void Messenger::transmit(AgvId sender, std::uint32_t slot, std::uint32_t receiver) {
  const std::uint32_t ordinal = slice_of(sender).sent.next(run_.now);
  ++run_.counters.messages_sent;
  const Message& message = pool_[slot];
  const std::size_t size = message.bytes.size();
  pool_.set_number(slot, static_cast<std::uint32_t>(run_.counters.messages_sent));
  run_.trace(sender, traced::Sent{AgvId{receiver}, message.hash, static_cast<std::uint32_t>(size), message.number},
             message.bytes);
  const Pose from = needs_places_ ? run_.pose_now(sender) : Pose{};
  const Duration air_time = run_.scenario.radio.air_time(size);
  const bool contended = run_.scenario.radio.contention.interference;
  pool_.goes_out(slot, contended ? channel_.contend(sender, run_.now, ordinal, air_time)
                                 : AirInterval{run_.now, run_.now + air_time});
  if (receiver != FP_NONE) {
    transmit_to(sender, AgvId{receiver}, slot, from);
  } else {
    for (std::size_t i = 0; i < slices_.size(); ++i) {
      if (AgvId{i} != sender) transmit_to(sender, AgvId{i}, slot, from);
    }
  }
  pool_.release(slot);
}

void Messenger::transmit_to(AgvId sender, AgvId receiver, std::uint32_t slot, const Pose& from) {
  Counters& counters = run_.counters;
  LinkPlaces places{from.position_m, {}};
  if (needs_places_) places.receiver_m = run_.pose_now(receiver).position_m;
  if (!unlimited_range_ && (places.receiver_m - places.sender_m).norm() > run_.scenario.radio.range_m) {
    ++counters.out_of_range;
    return pool_.release(slot);
  }
  const std::uint32_t ordinal = links_[sender.index() * slices_.size() + receiver.index()].next(run_.now);
  const Fate fate = radio_.fate(sender, receiver, run_.now, ordinal, places, pool_[slot].spared);
  const SimTime on_air_until = pool_[slot].on_air.end;
  const SimTime arrival = std::max(run_.now + fate.delay, on_air_until);
  ++counters.receptions;
  counters.delay_sum_ns += static_cast<std::uint64_t>((arrival - run_.now).count());
  if (run_.writer.has_sink()) note_fate(sender, receiver, ordinal, slot, fate);
  if (fate.lost) return lose(receiver, slot, fate);
  if (run_.scenario.radio.contention.interference && !fate.given)
    run_.queue.push(on_air_until, receiver, Event::Kind::MessageArrives, slot | kAirTimeEnds);
  run_.queue.push(arrival, receiver, Event::Kind::MessageArrives, slot);
  if (fate.copy_delay) {
    pool_.hold(slot);
    run_.queue.push(std::max(run_.now + *fate.copy_delay, on_air_until), receiver, Event::Kind::MessageArrives,
                    slot | kCopy);
  }
}

void Messenger::note_fate(AgvId sender, AgvId receiver, std::uint32_t ordinal, std::uint32_t slot, const Fate& fate) {
  const Duration least = pool_[slot].on_air.end - run_.now;
  traced::FateDecided decided{.sender = sender, .ordinal = ordinal, .lost = fate.lost, .number = pool_[slot].number};
  decided.due_after = std::max(fate.delay, least);
  run_.note(receiver, decided);
  if (fate.lost || !fate.copy_delay) return;
  decided.is_copy = true;
  decided.due_after = std::max(*fate.copy_delay, least);
  run_.note(receiver, decided);
}

void Messenger::lose(AgvId receiver, std::uint32_t slot, const Fate& fate) {
  Counters& counters = run_.counters;
  ++counters.receptions_lost;
  const TraceKind cause = fate.to_source   ? TraceKind::LostToSource
                          : fate.in_outage ? TraceKind::LostInOutage
                                           : TraceKind::Lost;
  counters.lost_in_outage += cause == TraceKind::LostInOutage ? 1 : 0;
  counters.lost_to_sources += cause == TraceKind::LostToSource ? 1 : 0;
  run_.trace(receiver, traced::Reception{cause, pool_[slot].sender, pool_[slot].hash, pool_[slot].number});
  pool_.release(slot);
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
    if (other == receiver || unlimited_range_) return true;
    return (run_.pose_now(other).position_m - run_.pose_now(receiver).position_m).norm() <= run_.scenario.radio.range_m;
  });
}

// ---- receiving

void Messenger::arrives(AgvId receiver, std::uint64_t payload) {
  const auto bits = static_cast<std::uint32_t>(payload);
  const std::uint32_t slot = bits & kSlot;
  if ((bits & kAirTimeEnds) != 0) return air_time_ends(receiver, slot);
  const Message& message = pool_[slot];
  if (message.is_destroyed_at(receiver)) return pool_.release(slot);
  if ((bits & kCopy) != 0) ++run_.counters.duplicates;
  run_.trace(receiver, traced::Reception{TraceKind::Received, message.sender, message.hash, message.number});
  ++run_.counters.received;
  if (!agents_.is_up(receiver)) return pool_.release(slot);
  Slice& slice = slice_of(receiver);
  const bool had_unread = slice.has_unread();
  slice.inbox.push_back(slot);
  if (had_unread && agents_.has_events_waiting(receiver)) return;  // the agent will read its inbox anyway
  fp_event event{};
  event.kind = FP_EVENT_MESSAGE;
  agents_.tell(receiver, event);
}

bool Messenger::read(AgvId agv, fp_message& out) {
  put_down(agv);
  Slice& slice = slice_of(agv);
  if (!slice.has_unread()) return false;
  slice.in_hand = slice.inbox[slice.read++];
  if (!slice.has_unread()) {
    slice.inbox.clear();
    slice.read = 0;
  }
  const Message& message = pool_[slice.in_hand];
  out.sender = message.sender.value;
  out.size = static_cast<std::uint32_t>(message.bytes.size());
  out.bytes = message.bytes.data();
  return true;
}

void Messenger::put_down(AgvId agv) {
  Slice& slice = slice_of(agv);
  if (slice.in_hand == FP_NONE) return;
  pool_.release(slice.in_hand);
  slice.in_hand = FP_NONE;
}

void Messenger::forget_inbox(AgvId agv) {
  Slice& slice = slice_of(agv);
  for (std::size_t i = slice.read; i < slice.inbox.size(); ++i) pool_.release(slice.inbox[i]);
  slice.inbox.clear();
  slice.read = 0;
}

}  // namespace fleetproof
