#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/engine/inbox.hpp"
#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"
#include "core/radio/radio.hpp"
#include "core/radio/radio_channel.hpp"
#include "core/radio/radio_reach.hpp"

namespace fleetproof {

// Messages between AGVs: a transmission has an air time of its own and one reception for each receiver in range. What
// arrives waits in the receiver's inbox.
class Messenger {
 public:
  Messenger(RunContext& run, AgentHostPort agents);

  // Call this for each piece of an AGV that begins after time zero: roaming depends on the path of the AGV.
  void piece_begins(const Piece& piece) {
    radio_.piece_begins(piece);
    if (reach_) reach_->piece_begins(piece);
  }
  void forget_path(AgvId agv) {
    radio_.forget_path(agv);
    if (reach_) reach_->forget(agv);
  }

  // Takes a message in hand that is going to be sent to `receiver`, or to all AGVs if that is FP_NONE. Returns its
  // slot, or nothing if the message is too long or there is no such receiver. Requires: `transmit` or `withdraw`.
  std::optional<std::uint32_t> accept(AgvId sender, std::string_view bytes, std::uint32_t receiver);
  void transmit(AgvId sender, std::uint32_t slot, std::uint32_t receiver);
  std::uint64_t hash_of(std::uint32_t slot) const { return pool_[slot].hash; }
  // The radio neither loses nor delays this message. Call it before `transmit`. The message is still in the air for its
  // air time, and interference may still destroy it.
  void spare(std::uint32_t slot) { pool_.spare(slot); }
  void withdraw(std::uint32_t slot) { pool_.release(slot); }
  // The event. `payload` is the messenger's own.
  void arrives(AgvId receiver, std::uint64_t payload);

  // The oldest message of the inbox, whose bytes stay valid until the next `read`; false: there is none.
  bool read(AgvId agv, fp_message& out);
  void forget_inbox(AgvId agv);

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
  struct Slice {
    Inbox inbox;
    std::uint32_t in_hand = FP_NONE;
    SentCount sent;  // to any receiver
  };
  // What an AGV sent at the last instant at which it sent: the number of messages to each receiver, and the receivers
  // of those that did not go to all.
  struct SentTo {
    std::vector<std::uint32_t> counts;
    std::vector<AgvId> receivers;
  };
  Slice& slice_of(AgvId agv) { return slices_[agv.index()]; }
  void put_down(Slice& slice);
  void all_hear(AgvId sender, std::uint32_t ordinal);
  void find_hearers(AgvId sender, std::uint32_t ordinal, std::uint32_t receiver, const Vec2& from_m);
  void find_hearers_in_range(AgvId sender, const Vec2& from_m);
  bool is_in_range(AgvId receiver, const Vec2& from_m) const;
  // `sent`: the row of the sender.
  void hears(AgvId receiver, SentTo& sent) {
    std::uint32_t& count = sent.counts[receiver.index()];
    if (count == 0) sent.receivers.push_back(receiver);
    hearers_[hearing_++] = {receiver, count++};
  }
  void deliver_together(AgvId sender, std::uint32_t slot);
  void deliver_plainly(std::uint32_t slot);
  void count_receptions(std::uint32_t slot, std::size_t arriving);
  void deliver(AgvId sender, std::size_t hearer, std::uint32_t slot, const Vec2& from_m);
  // For an observer that wants to write the run's fates down.
  void note_fate(AgvId sender, const Hearer& hearer, std::uint32_t slot, const Fate& fate);
  void lose(AgvId receiver, std::uint32_t slot, TraceKind cause);
  void air_time_ends(AgvId receiver, std::uint32_t slot);
  bool is_drowned(AgvId receiver, const Message& message) const;

  RunContext& run_;
  AgentHostPort agents_;
  Radio radio_;
  RadioChannel channel_;
  MessagePool pool_;
  struct AirTime {
    std::size_t bytes;
    Duration lasts;
  } air_time_;  // of a message that is as long as the last one
  bool unlimited_range_;
  bool needs_places_;                // the fate of a message depends on where its ends are
  std::optional<RadioReach> reach_;  // if the range is limited
  std::vector<Slice> slices_;        // by AGV
  std::vector<SentTo> sent_to_;      // by sender; a row is empty until its AGV sends
  // Of the message being sent: who hears it, in order, in the first `hearing_` places; and the draws of each.
  std::vector<Hearer> hearers_;
  std::size_t hearing_ = 0;
  std::vector<Block> draws_;
};

}  // namespace fleetproof
