#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/radio/delay_model.hpp"
#include "core/radio/outage_process.hpp"
#include "core/radio/radio_channel.hpp"
#include "core/radio/radio_crossings.hpp"
#include "core/radio/radio_places.hpp"
#include "core/radio/radio_sources.hpp"
#include "core/radio/recorded_radio.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// What becomes of one transmission at one receiver, air time and interference apart.
struct Fate {
  bool lost = false;
  bool in_outage = false;  // lost or not: the link or the place is in an outage, or an AGV is changing its access point
  bool to_source = false;  // lost, and but for an external source it would not be
  Duration delay{};  // from sending to the inbox if the air time is no longer; for a lost one too, so that losses shift
                     // nothing
  std::optional<Duration> copy_delay{};  // of a second copy, likewise
};

// Reference points of both ends at the instant of sending. Needed only where the radio depends on place.
struct LinkPlaces {
  Vec2 sender_m = Vec2::Zero(), receiver_m = Vec2::Zero();
};

// The radio as a function of (sender, receiver, places, instant, number among the messages of that instant): one
// message more moves no other's fate, and a higher loss rate only adds losses. It remembers where each outage process
// has got to, for speed alone: for one run, on one thread.
class Radio {
 public:
  Radio(const RadioSetup& setup, std::uint64_t world_seed);
  bool depends_on_place() const { return depends_on_place_; }
  // To be told of every piece of every AGV, but for those with which they begin: what comes of the AGV's way hangs on
  // them.
  void piece_begins(const Piece& piece) {
    if (crossings_.is_on()) crossings_.piece_begins(piece);
  }
  void is_carried(AgvId agv) { crossings_.is_carried(agv); }
  Fate fate(AgvId sender, AgvId receiver, SimTime sent, std::uint32_t ordinal, const LinkPlaces& places = {});
  // The outage process that this receiver meets on messages of this sender. Scope Place has none.
  OutageProcess& process_of(AgvId sender, AgvId receiver);

 private:
  struct StateLoss {
    double good, bad;
  };
  StateLoss losses_by_state(double loss) const;
  OutageLaw outage_law(double loss) const;
  double loss_of(AgvId sender, AgvId receiver) const;
  void weigh_states(Fate& fate, double loss_draw, AgvId sender, AgvId receiver, SimTime sent, const LinkPlaces& places);
  std::optional<Duration> copy_of(const MessageKey& message) const;

  RadioSetup setup_;
  std::uint64_t key_, state_key_, copy_key_;
  DelayModel delay_;
  bool has_states_, depends_on_place_;
  RecordedRadio recorded_;
  RadioPlaces places_;
  RadioCrossings crossings_;
  RadioSources sources_;
  std::vector<std::vector<std::optional<OutageProcess>>>
      links_;  // by sender (the smaller id where directions share one), receiver
};

// A message in the air or in inboxes.
struct Message {
  AgvId sender;
  std::string bytes;
  std::uint64_t hash = 0;
  std::uint32_t copies = 0;  // receptions still under way or unread
  // With interference: the receivers at which it was destroyed.
  AirInterval on_air;
  std::vector<AgvId> destroyed_at;
  bool is_destroyed_at(AgvId receiver) const { return std::ranges::find(destroyed_at, receiver) != destroyed_at.end(); }
};

// Messages by slot; a slot is used again when its last copy has been read or lost.
class MessagePool {
 public:
  std::uint32_t add(AgvId sender, std::string_view bytes, std::uint32_t copies);
  const Message& operator[](std::uint32_t slot) const { return messages_[slot]; }
  void hold(std::uint32_t slot) { ++messages_[slot].copies; }
  void goes_out(std::uint32_t slot, const AirInterval& on_air) { messages_[slot].on_air = on_air; }
  void destroy_at(std::uint32_t slot, AgvId receiver) { messages_[slot].destroyed_at.push_back(receiver); }
  void release(std::uint32_t slot);
  // Of a message that is never going to be sent: all its copies.
  void release_unsent(std::uint32_t slot);

 private:
  std::vector<Message> messages_;
  std::vector<std::uint32_t> free_;
};

}  // namespace fleetproof
