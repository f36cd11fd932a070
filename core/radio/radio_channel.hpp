#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/base/strong_id.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

inline constexpr std::uint32_t kLongestMessage_bytes = 1024;

// From the first instant of a transmission to its last, which is not part of it: one that begins as another ends does
// not touch it.
struct AirInterval {
  SimTime begin{}, end{};
  bool overlaps(const AirInterval& other) const { return begin < other.end && other.begin < end; }
  friend bool operator==(const AirInterval&, const AirInterval&) = default;
};

// The air that transmissions share, see InterferenceSetup. With n senders that always have something to send, all of
// one length, each sends in a slot with probability 2 / (CW + 2), independently of the others, so a message is lost at
// a listener with probability 1 - (1 - 2 / (CW + 2))^(n - 1): the saturated broadcast of IEEE 802.11, which has neither
// acknowledgement nor retry. Slots are of equal length here, busy or idle, so waiting for a free one takes longer than
// in a real network of little load. Nobody listens before it sends: among transmissions of unlike length, which share
// no slots, a long one is hit by each short one that begins meanwhile, as if all senders were hidden from each other.
// For one run, on one thread.
class RadioChannel {
 public:
  RadioChannel(const RadioSetup& setup, std::uint64_t world_seed);

  // When this message is in the air. Instants do not decrease from call to call.
  AirInterval contend(AgvId sender, SimTime sent, std::uint32_t ordinal, Duration air_time);

  // Whether `is_one` holds for another sender with a transmission in the air during this one. Known at this one's last
  // instant, and only then.
  template <class Predicate>
  bool any_other_on_air(AgvId sender, const AirInterval& during, Predicate is_one) const {
    for (auto it = on_air_.lower_bound({during.begin - longest_, AgvId{0U}});
         it != on_air_.end() && it->first.first < during.end; ++it) {
      const auto& [begin, other] = it->first;
      if (other != sender && during.overlaps({begin, it->second}) && is_one(other)) return true;
    }
    return false;
  }

 private:
  std::uint32_t contention_window_;
  std::uint64_t key_;
  Duration longest_{};                                   // of all so far
  std::vector<SimTime> free_from_;                       // by sender: end of its last transmission
  std::map<std::pair<SimTime, AgvId>, SimTime> on_air_;  // by begin and sender, which tell transmissions apart: end
};

}  // namespace fleetproof
