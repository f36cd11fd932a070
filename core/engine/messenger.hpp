// Messages from sender to inbox.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/engine/hearers.hpp"
#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"
#include "core/radio/message_pool.hpp"
#include "core/radio/radio.hpp"
#include "core/radio/radio_channel.hpp"

namespace fleetproof {

// The unread messages of a participant, oldest first. A message is named by its slot in the message pool.
class Inbox {
 public:
  bool empty() const { return read_ == end_; }
  std::span<const std::uint32_t> unread() const { return {slots_.get() + read_, slots_.get() + end_}; }

  void push(std::uint32_t slot) {
    if (end_ == capacity_) make_room();
    slots_[end_++] = slot;
  }
  // Requires: it is not empty.
  std::uint32_t take() {
    const std::uint32_t slot = slots_[read_++];
    if (empty()) clear();
    return slot;
  }
  void clear() { read_ = end_ = 0; }

 private:
  // Out of the way of `push`, which needs it seldom.
  [[gnu::noinline]] void make_room() {
    const std::uint32_t waiting = end_ - read_;
    capacity_ = std::max(16U, 2 * waiting);
    auto more = std::make_unique_for_overwrite<std::uint32_t[]>(capacity_);
    std::ranges::copy(unread(), more.get());
    slots_ = std::move(more);
    read_ = 0;
    end_ = waiting;
  }

  std::unique_ptr<std::uint32_t[]> slots_;
  std::uint32_t read_ = 0, end_ = 0, capacity_ = 0;
};

// Messages between participants: a transmission has an air time of its own and one reception for each receiver in
// range. Between computers a message goes by wire, which loses nothing. What arrives waits in the receiver's inbox.
class Messenger {
 public:
  Messenger(RunContext& run, AgentHostPort agents);

  // Call this for each piece of an AGV that begins after time zero: roaming depends on the path of the AGV.
  void piece_begins(const Piece& piece) {
    radio_.piece_begins(piece);
    hearers_.piece_begins(piece);
  }
  void forget_path(AgvId agv) {
    radio_.forget_path(agv);
    hearers_.forget_path(agv);
  }

  // Takes a message in hand that is going to be sent to `receiver`, or to all if that is FP_NONE. Returns its
  // slot, or nothing if the message is too long or there is no such receiver. Requires: `transmit` or `withdraw`.
  std::optional<std::uint32_t> accept(AgvId sender, std::string_view bytes, std::uint32_t receiver);
  void transmit(AgvId sender, std::uint32_t slot, std::uint32_t receiver);
  std::uint64_t hash_of(std::uint32_t slot) const { return pool_[slot].hash; }
  // The radio neither loses nor delays this message. Call it before `transmit`. The message is still in the air for its
  // air time, and interference may still destroy it.
  void spare(std::uint32_t slot) { pool_[slot].spared = true; }
  void withdraw(std::uint32_t slot) { pool_.release(slot); }
  // The event. `payload` is the messenger's own.
  void arrives(AgvId receiver, std::uint64_t payload);

  // The oldest message of the inbox, whose bytes stay valid until the next `read`; false: there is none.
  bool read(AgvId agv, fp_message& out);
  // The messages of the inbox, oldest first, which stay there. Valid until the next call of this object.
  std::span<const fp_message> unread(AgvId agv);
  void forget_inbox(AgvId agv);
  // At the end of the run: what becomes of messages that were never sent.
  void settle_accounts();

 private:
  // How many messages have been sent at the last instant of sending.
  struct SentCount {
    SimTime at = kStart;
    std::uint32_t count = 0;
    // The number of a further message among those of its instant, from 0 on.
    std::uint32_t next(SimTime now) {
      if (at != now) count = 0;
      at = now;
      return count++;
    }
  };
  struct AgvState {
    Inbox inbox;
    std::uint32_t in_hand = FP_NONE;
    SentCount sent;  // to any receiver
  };
  AgvState& agv_state_of(AgvId agv) { return agv_states_[agv.index()]; }
  void put_down(AgvState& agv_state);
  void deliver_in_range(std::uint32_t slot, std::uint32_t number);
  void deliver_one_by_one(std::uint32_t slot, std::uint32_t to);
  template <class HearerAt>
  void deliver_together(std::uint32_t slot, std::size_t hearing, HearerAt hearer_at);
  std::span<const Hearer> deliver_by_wire(std::uint32_t slot, std::span<const Hearer> hearers);
  void deliver_plainly(std::uint32_t slot, std::span<const Hearer> hearers);
  void count_receptions(Message& message, std::size_t hearing, std::size_t arriving);
  void deliver(const Hearer& hearer, const Block& draws, std::uint32_t slot, const std::optional<Vec2>& from_m);
  // For an observer that wants to write the run's deliveries down.
  void note_delivery(const Hearer& hearer, const Message& message, const Delivery& delivery);
  void lose(AgvId receiver, const Message& message, TraceKind cause);
  bool is_heard(AgvId receiver, std::uint32_t bits);
  void air_time_ends(AgvId receiver, std::uint32_t slot);
  bool is_drowned(AgvId receiver, const Message& message) const;

  RunContext& run_;
  AgentHostPort agents_;
  Radio radio_;
  RadioChannel channel_;
  MessagePool pool_;
  Hearers hearers_;
  struct AirTime {
    std::size_t bytes;
    Duration lasts;
  } air_time_;         // of a message that is as long as the last one
  bool contended_;     // transmissions compete for air
  bool needs_places_;  // the delivery of a message depends on where its ends are
  // Of a message that is not spared: nothing but its draws decides its delivery, and nobody notes it; and they only
  // decide whether it is lost.
  bool draws_decide_, losses_decide_;
  std::size_t others_;  // so many AGVs but the sender
  struct Wire {
    Duration takes;
    std::uint64_t received = 0;
  } wire_;
  std::vector<AgvState> agv_states_;  // by participant
  std::vector<Block> draws_;          // of those who hear the message being sent
  std::vector<fp_message> unread_;    // as somebody has asked for them last
};

}  // namespace fleetproof
