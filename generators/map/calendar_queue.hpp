#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/base/sim_time.hpp"

namespace fleetproof {

// The open stations of a search for quickest ways, the nearest first. Popped costs never decrease. A pushed cost is
// ahead of the last popped cost by at most the longest hop. The queue has sixteen slots, which are used in turns. Each
// slot covers so much time that the longest hop fits into fifteen slots. The few stations in a slot are scanned. With
// few open stations, this is a third of the work of a heap; with hundreds, it is no more than a heap. The order of
// stations with equal costs depends only on the pushes and pops before.
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

  // Requires: the queue is not empty.
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

  // Starts at cost 0 again. Requires: the queue is empty.
  void rewind() { slot_ = 0; }

 private:
  static constexpr unsigned kSlots = 16;

  int shift_;
  unsigned slot_ = 0;         // of the last popped station
  std::uint16_t filled_ = 0;  // bit by slot
  std::array<std::vector<Open>, kSlots> slots_;
};

}  // namespace fleetproof
