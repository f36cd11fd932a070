#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/radio_setup.hpp"

namespace fleetproof {

// The air that transmissions share, see InterferenceSetup. With n senders that always have something to send, each sends in a slot with
// probability 2 / (CW + 2), independently of the others, so a message is lost at a listener with probability 1 - (1 - 2 / (CW + 2))^(n - 1):
// the saturated broadcast of IEEE 802.11, which has neither acknowledgement nor retry. Slots are of equal length here, busy or idle, so waiting for a
// free one takes longer than in a real network of little load.
// For one run, on one thread.
class RadioChannel {
 public:
  RadioChannel(const RadioSetup& setup, std::uint64_t world_seed);

  // The slot in which this message goes out. Instants do not decrease from call to call.
  std::int64_t contend(AgvId sender, SimTime sent, std::uint32_t ordinal);
  SimTime end_of(std::int64_t slot) const { return kStart + slot_ * (slot + 1); }
  // Who sends in a slot; complete as soon as the slot has begun, kept until all of it is over.
  std::span<const AgvId> senders_in(std::int64_t slot) const;

 private:
  std::int64_t slot_at(SimTime t) const { return t.time_since_epoch() / slot_; }

  Duration slot_;
  std::uint32_t contention_window_;
  std::uint64_t key_;
  std::vector<std::int64_t> last_slot_;  // by sender; -1: has not sent
  std::map<std::int64_t, std::vector<AgvId>> senders_;
};

}  // namespace fleetproof
