#pragma once

#include <cstdint>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"

namespace fleetproof {

// When each message of one sender was last sent, for a whole run: a delay has no bound. A table with open addressing,
// because every reception looks into it.
class SentMessages {
 public:
  // `receiver` invalid: every AGV in range.
  void note(std::uint64_t message_hash, AgvId receiver, SimTime at);
  // SimTime::min() if no such message was sent.
  SimTime last_sent(std::uint64_t message_hash, AgvId receiver) const;

 private:
  struct Slot {
    std::uint64_t message_hash = 0;
    AgvId receiver;
    SimTime at = SimTime::min();  // free
  };
  // The slot of the message, or the free one where it belongs. Requires: a free slot.
  std::size_t slot_of(std::uint64_t message_hash, AgvId receiver) const;
  void grow();

  std::vector<Slot> slots_;  // a power of two of them, at most half of them used
  std::size_t used_ = 0;
};

}  // namespace fleetproof
