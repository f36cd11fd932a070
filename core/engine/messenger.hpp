#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "core/engine/ports.hpp"
#include "core/engine/run_context.hpp"
#include "core/radio/radio.hpp"
#include "core/radio/radio_channel.hpp"

namespace fleetproof {

// Messages between AGVs: a transmission has an air time of its own and one reception for each receiver in range. What
// arrives waits in the receiver's inbox.
class Messenger {
 public:
  Messenger(RunContext& run, AgentHostPort agents);

  // Call this for each piece of an AGV that begins after time zero: roaming depends on the path of the AGV.
  void piece_begins(const Piece& piece) { radio_.piece_begins(piece); }
  void forget_path(AgvId agv) { radio_.forget_path(agv); }

  // Takes a message in hand that is going to be sent to `receiver`, or to all AGVs if that is FP_NONE. Returns its
  // slot, or nothing if the message is too long or there is no such receiver. Requires: `transmit` or `withdraw`.
  std::optional<std::uint32_t> accept(AgvId sender, std::string_view bytes, std::uint32_t receiver);
  void transmit(AgvId sender, std::uint32_t slot, std::uint32_t receiver);
  std::uint64_t hash_of(std::uint32_t slot) const { return pool_[slot].hash; }
  // The radio neither loses nor delays this message. Call it before `transmit`.
  void spare(std::uint32_t slot) { pool_.spare(slot); }
  void withdraw(std::uint32_t slot) { pool_.release_unsent(slot); }
  // The event. `payload` is the messenger's own.
  void arrives(AgvId receiver, std::uint64_t payload);

  // The oldest message of the inbox, whose bytes stay valid until `put_down` or the next `read`; false: there is none.
  bool read(AgvId agv, fp_message& out);
  void put_down(AgvId agv);
  void forget_inbox(AgvId agv);

 private:
  // How many messages have been sent at the last instant of sending.
  struct SentCount {
    SimTime at = SimTime::min();
    std::uint32_t count = 0;
    // The number of a further message among those of its instant, from 0 on.
    std::uint32_t next(SimTime now) {
      count = at == now ? count + 1 : 0;
      at = now;
      return count;
    }
  };
  struct Slice {
    std::vector<std::uint32_t> inbox;  // slots, oldest first, from `read` on
    std::size_t read = 0;
    std::uint32_t in_hand = FP_NONE;
    SentCount sent;  // to any receiver
    bool has_unread() const { return read < inbox.size(); }
  };
  Slice& slice_of(AgvId agv) { return slices_[agv.index()]; }
  void transmit_to(AgvId sender, AgvId receiver, std::uint32_t slot, const Pose& from);
  // For an observer that wants to write the run's fates down.
  void note_fate(AgvId sender, AgvId receiver, std::uint32_t ordinal, std::uint32_t slot, const Fate& fate);
  void lose(AgvId receiver, std::uint32_t slot, const Fate& fate);
  void air_time_ends(AgvId receiver, std::uint32_t slot);
  bool is_drowned(AgvId receiver, const Message& message) const;

  RunContext& run_;
  AgentHostPort agents_;
  Radio radio_;
  RadioChannel channel_;
  MessagePool pool_;
  bool unlimited_range_;
  bool needs_places_;             // the fate of a message depends on where its ends are
  std::vector<Slice> slices_;     // by AGV
  std::vector<SentCount> links_;  // by sender and receiver: of messages from the one to the other
};

}  // namespace fleetproof
