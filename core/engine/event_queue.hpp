#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"
#include "core/engine/event_row.hpp"

namespace fleetproof {

// Something that will happen. The meaning of `payload` and `stamp` depends on the kind. If the stamp no longer matches,
// the event is stale and nothing happens.
struct Event {
  enum class Kind : std::uint8_t {
    Start,
    OrderReleased,
    ActivityEnds,
    CallTakesEffect,
    MessageArrives,
    TimerGoesOff,
    AgentIsFree,
    Contact,
    BatteryEmpty,
    FaultStrikes,
    FaultOver,
    BodyAppears,
    BodyLeaves,
    ScannerLooks,
    OperatorComes,
    OperatorLooks
  };

  SimTime at;
  EntityId entity;
  Kind kind = Kind::Start;
  std::uint64_t sequence = 0;
  std::uint64_t payload = 0;
  std::uint64_t stamp = 0;
};

// Events in order of (time, entity, sequence). This is a total order: neither memory layout nor threads can change it.
//
// Most events of a run are arrivals of messages, and most of them are pushed in order of time, because they are equally
// late. These stand in a lane, one behind the other. All other events are filed: timers in a row if they are pushed in
// order, and the rest in a heap.
class EventQueue {
 public:
  // Requires of every entity: it is below kNoEntity, or invalid.
  static constexpr std::uint32_t kNoEntity = 0xffffff;
  // An event of the kind MessageArrives in the lane.
  struct Arrival {
    SimTime at;
    std::uint64_t order;
    std::uint32_t payload;
    EntityId receiver() const { return EntityId{static_cast<std::uint32_t>(order >> kSequenceBits)}; }
  };

  EventQueue() { heap_.reserve(256); }

  void push(SimTime at, EntityId entity, Event::Kind kind, std::uint64_t payload = 0, std::uint64_t stamp = 0);
  // The same for an event of the kind MessageArrives at each of these, one after the other.
  void push_arrivals(SimTime at, std::span<const EntityId> entities, std::uint32_t payload);
  // The same for arrivals that are found one by one. Room for so many in the lane, or null if they must be pushed one
  // by one; each of them; and how many have been written there.
  Arrival* room_in_lane(SimTime at, std::size_t arrivals) {
    return goes_into_lane(at) ? lane_.room_for(arrivals) : nullptr;
  }
  Arrival arrival(SimTime at, EntityId receiver, std::uint32_t payload) {
    return {at, order_of(receiver, sequence_++), payload};
  }
  void stand_in_lane(std::size_t arrivals) { lane_.added(arrivals); }

  bool empty() const { return lane_.empty() && filed_order_ == kNothing; }
  // Takes the next event, if it is at or before `end`; else false.
  bool pop_until(SimTime end, Event& event);
  // Requires: there is an event.
  Event pop();

  // The same in two steps. It costs less, because an arrival does not become an event.
  // Whether the next event is an arrival in the lane. The arrivals of one instant are sorted when the run reaches that
  // instant. While some of them are left, no further one joins them.
  bool arrival_comes_first() {
    if (lane_.empty() || filed_at_ < lane_.front().at) return false;
    if (opened_ == 0) open_instant();
    return lane_.front().at < filed_at_ || lane_.front().order < filed_order_;
  }
  // If an arrival comes first:
  const Arrival& first_arrival() const { return lane_.front(); }
  void drop_arrival() {
    lane_.drop_front();
    --opened_;
  }
  // If none comes first: as `pop_until`.
  bool pop_filed_until(SimTime end, Event& event) {
    if (filed_at_ > end || filed_order_ == kNothing) return false;
    take_filed(event);
    return true;
  }

 private:
  // Entity and sequence in one number, which compares as they do.
  static constexpr unsigned kSequenceBits = 40, kKindBits = 8;
  static constexpr std::uint64_t kNothing = ~std::uint64_t{0};  // the order of no event
  static constexpr std::uint64_t order_of(EntityId entity, std::uint64_t sequence) {
    return std::uint64_t{std::min(entity.value, kNoEntity)} << kSequenceBits | sequence;
  }
  static constexpr std::uint64_t sequence_in(std::uint64_t order) {
    return order & ((std::uint64_t{1} << kSequenceBits) - 1);
  }
  struct Filed {
    SimTime at;
    std::uint64_t order = 0;
    std::uint64_t stamp = 0;
    std::uint64_t payload_and_kind = 0;
  };
  template <class One, class Other>
  static bool is_before(const One& one, const Other& other) {
    return one.at != other.at ? one.at < other.at : one.order < other.order;
  }

  void push_on_heap(const Filed& filed);
  Filed take_from_heap();
  void take_filed(Event& event);
  void find_first_filed();
  void open_instant();
  void put_in_order(std::span<Arrival> instant);
  bool goes_into_lane(SimTime at) const {
    return lane_.empty() || at > lane_.back().at || (at == lane_.back().at && opened_ < lane_.size());
  }

  EventRow<Arrival> lane_;   // in order of time
  std::size_t opened_ = 0;   // so many arrivals at its front are in order; those at one instant are opened together
  EventRow<Filed> timers_;   // in order
  std::vector<Filed> heap_;  // the next event is at the front
  // The first filed event, and whether it is a timer in the row.
  SimTime filed_at_ = kForever;
  std::uint64_t filed_order_ = kNothing;
  bool filed_in_row_ = false;
  std::uint64_t sequence_ = 0;
  // Only while an instant is put in order.
  std::vector<std::uint32_t> places_;
  std::vector<Arrival> in_order_;
};

}  // namespace fleetproof
