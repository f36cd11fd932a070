#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/base/strong_id.hpp"
#include "core/scenario/draw_numbers.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

inline constexpr std::uint32_t kLongestMessage_bytes = 1024;

// The time of a transmission. `end` is not part of it: a transmission that begins when another ends does not overlap
// the other.
struct AirInterval {
  SimTime begin{}, end{};
  bool overlaps(const AirInterval& other) const { return begin < other.end && other.begin < end; }
  friend bool operator==(const AirInterval&, const AirInterval&) = default;
};

// The air that transmissions share, see InterferenceSetup. Suppose n senders always have a message to send, all of one
// length. Each of them then sends in a slot with probability 2 / (CW + 2), independently of the others. A receiver
// loses a message with probability 1 - (1 - 2 / (CW + 2))^(n - 1). This is the saturated broadcast of IEEE 802.11,
// which has neither acknowledgement nor retry.
//
// Limits of the model: busy and idle slots have the same length, so a sender waits longer for a free slot than in a
// real network with little traffic. No AGV listens before it sends. Transmissions of different lengths share no slots:
// a short transmission that begins during a long one destroys it, as between senders that are hidden from each other.
// Threads: one object serves one run on one thread.
class RadioChannel {
 public:
  RadioChannel(const RadioSetup& setup, std::uint64_t world_seed, DrawNumbers numbers = {});

  // The time at which this message is in the air. Requires: `sent` does not decrease from call to call.
  AirInterval contend(AgvId sender, SimTime sent, std::uint32_t ordinal, Duration air_time);

  // Whether another sender for which `is_one` is true has a transmission that overlaps `during`.
  // Requires: the time is the end of `during`; earlier, further transmissions may still begin.
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
  DrawNumbers numbers_;
  Duration longest_{};                                   // the longest air time so far
  std::vector<SimTime> free_from_;                       // by sender: the end of its last transmission
  std::map<std::pair<SimTime, AgvId>, SimTime> on_air_;  // by begin and sender: the end of the transmission
};

}  // namespace fleetproof
