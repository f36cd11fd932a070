// The quickest ways of a vehicle type from one station to all others.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/scenario/scenario.hpp"
#include "core/scenario/ways.hpp"

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

// The quickest ways from one station to all others. An AGV drives every lane from rest to rest, like an agent that does
// not coordinate. The choice of the ways ignores turns; the times of arrival include turns. There is no turn before the
// first lane.
struct QuickestWays {
  static constexpr std::uint32_t kNone = kNoLane;

  struct Arrival {
    Duration drives_off{}, arrives{};  // start (after the turn) and end of the drive on the last lane
    std::uint32_t lane = kNone;        // the last lane; kNone at `from`, and if there is no way
    std::uint32_t first = kNone;       // the first lane; kNone where `lane` is
    bool unique = false;               // no other way is as quick, to the microsecond
  };

  StationId from;
  std::vector<Arrival> arrivals;  // by station

  const Arrival& at(StationId station) const { return arrivals[station.index()]; }
  // Lanes from `from` to `station`, in the order they are driven.
  std::vector<std::uint32_t> lanes(const LogicalMap& map, StationId station) const;
};

// The quickest ways of one vehicle type. A search happens at the first question. Requires: map and type outlive the
// timetable.
class Timetable {
 public:
  Timetable(const LogicalMap& map, const VehicleType& type);

  const QuickestWays& from(StationId station);

  // How many arrivals it keeps, of 32 bytes each.
  std::size_t kept() const { return searches_ * ways_.size(); }
  // Frees them. What from() has returned is gone; later answers are the same.
  void forget();

 private:
  void search(QuickestWays& ways);
  void find_ways_on();
  std::span<const std::uint32_t> followed_from(StationId start);
  Duration pass(std::span<const std::uint32_t> followed);
  bool follow(QuickestWays& ways);
  void arrive(QuickestWays& ways, std::uint32_t station) const;
  Duration turn(std::uint32_t before, std::uint32_t after) const;
  Duration duration_of_turn(std::uint32_t before, std::uint32_t after) const;

  const LogicalMap& map_;
  const VehicleType& type_;
  // By lane. These members are side by side because the search reads them together.
  struct Hop {
    std::uint32_t from, to;
    Duration drive;
    std::uint32_t place;       // number of the lane in lanes_from() its start
    std::uint32_t first_turn;  // of those at its end, in turns_
  };
  std::vector<Hop> hops_;
  // By station: the only lane that leads on, not counting dead ends; kNone if there is none or more than one.
  std::vector<std::uint32_t> onward_;
  mutable std::vector<Duration> turns_;  // by lane, and place of the next one; negative: not asked for yet
  std::vector<QuickestWays> ways_;       // by station; empty: not asked for yet
  std::size_t searches_ = 0;             // those of them that are not empty

  // Memory of a search, kept for the next.
  std::vector<ReachedStation<std::int64_t>> reached_;  // by station, in ns
  std::vector<std::uint32_t> followed_;
  std::vector<QuickestWays::Arrival> passed_;
  std::vector<Duration> later_;  // by lane from the end of those followed
  std::optional<CalendarQueue> open_;
};

}  // namespace fleetproof
