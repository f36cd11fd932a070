#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/base/sim_time.hpp"

namespace fleetproof {

// The open stations of a search for quickest ways, the nearest first: costs that are popped never fall, and nothing is
// pushed further ahead of the last one popped than the longest hop. Sixteen slots, each for as much time as the longest
// hop needs to fit in fifteen, are used round and round; the few stations of one slot are looked through. A third of
// the work of a heap where a handful is open, no more where hundreds are. Of stations with one cost any may come first,
// always the same one after the same pushes and pops.
class CalendarQueue {
 public:
  struct Open {
    std::int64_t cost_ns;
    std::uint32_t station;
  };

  explicit CalendarQueue(Duration longest_hop)
      : shift_(static_cast<int>(std::bit_width(static_cast<std::uint64_t>(longest_hop.count()) / 15))) {}

  bool empty() const { return filled_ == 0; }

  void push(Open open) {
    const auto slot = static_cast<unsigned>(open.cost_ns >> shift_) % kSlots;
    slots_[slot].push_back(open);
    filled_ = static_cast<std::uint16_t>(filled_ | 1U << slot);
  }

  // Of a queue that is not empty.
  Open pop() {
    slot_ = (slot_ + static_cast<unsigned>(std::countr_zero(std::rotr(filled_, static_cast<int>(slot_))))) % kSlots;
    auto& slot = slots_[slot_];
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < slot.size(); ++i) {
      if (slot[i].cost_ns < slot[nearest].cost_ns) nearest = i;
    }
    const Open found = slot[nearest];
    slot[nearest] = slot.back();
    slot.pop_back();
    if (slot.empty()) filled_ = static_cast<std::uint16_t>(filled_ & ~(1U << slot_));
    return found;
  }

  // Of an empty queue: begins at 0 again.
  void rewind() { slot_ = 0; }

 private:
  static constexpr unsigned kSlots = 16;

  int shift_;
  unsigned slot_ = 0;         // of the last one popped
  std::uint16_t filled_ = 0;  // bit by slot
  std::array<std::vector<Open>, kSlots> slots_;
};

}  // namespace fleetproof
