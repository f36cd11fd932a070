// The events to come, in the order in which they happen: a lane of arrivals, a row of timers, a heap for the rest.
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"

namespace fleetproof {

// The place of an event among those of its instant: entity and sequence in one number, which compares as they do.
class EventOrder {
 public:
  // Requires of every entity: it is below kNoEntity, or invalid.
  static constexpr std::uint32_t kNoEntity = 0xffffff;

  constexpr EventOrder() = default;  // after every event
  constexpr EventOrder(EntityId entity, std::uint64_t sequence)
      : bits_(std::uint64_t{std::min(entity.value, kNoEntity)} << kSequenceBits | sequence) {}
  // Requires: the AGV is valid.
  static constexpr EventOrder of_agv(AgvId agv, std::uint64_t sequence) {
    EventOrder order;
    order.bits_ = std::uint64_t{agv.value} << kSequenceBits | sequence;
    return order;
  }

  constexpr EntityId entity() const { return agv().value == kNoEntity ? EntityId{} : agv(); }
  constexpr AgvId agv() const { return AgvId{static_cast<std::uint32_t>(bits_ >> kSequenceBits)}; }
  constexpr std::uint64_t sequence() const { return bits_ & ((std::uint64_t{1} << kSequenceBits) - 1); }

  friend constexpr auto operator<=>(const EventOrder&, const EventOrder&) = default;

 private:
  static constexpr unsigned kSequenceBits = 40;

  std::uint64_t bits_ = ~std::uint64_t{0};
};

// Of two things that have a time and an order.
template <class One, class Other>
constexpr bool is_before(const One& one, const Other& other) {
  return one.at != other.at ? one.at < other.at : one.order < other.order;
}

// Events that are added at the end and taken from the front, one behind the other in memory.
template <class Item>
class EventRow {
 public:
  bool empty() const { return next_ == end_; }
  std::size_t size() const { return end_ - next_; }
  // Requires, of these: it is not empty.
  const Item& front() const { return items_[next_]; }
  const Item& back() const { return items_[end_ - 1]; }
  void drop_front() {
    if (++next_ == end_) next_ = end_ = 0;
  }
  Item* begin() { return items_.get() + next_; }

  // Room for so many items behind the last; `added` says how many have been written there.
  Item* room_for(std::size_t items) {
    if (end_ + items > capacity_) [[unlikely]]
      make_room(items);
    return items_.get() + end_;
  }
  void added(std::size_t items) { end_ += items; }

 private:
  static constexpr std::size_t kFirstRoom = 256;

  // Most of a full row has been taken, or it becomes twice as long: either is seldom enough to cost nothing.
  [[gnu::noinline]] void make_room(std::size_t items) {
    const std::size_t waiting = size();
    std::unique_ptr<Item[]> longer;
    if (2 * (waiting + items) > capacity_) {
      capacity_ = std::max(kFirstRoom, 2 * (waiting + items));
      longer = std::make_unique_for_overwrite<Item[]>(capacity_);
    }
    std::copy_n(begin(), waiting, longer ? longer.get() : items_.get());
    if (longer) items_ = std::move(longer);
    end_ = waiting;
    next_ = 0;
  }

  std::unique_ptr<Item[]> items_;
  std::size_t next_ = 0, end_ = 0, capacity_ = 0;
};

// An event as the queue keeps it.
struct FiledEvent {
  static constexpr unsigned kKindBits = 8;
  SimTime at;
  EventOrder order;
  std::uint64_t stamp = 0;
  std::uint64_t payload_and_kind = 0;
  std::uint64_t payload() const { return payload_and_kind >> kKindBits; }
};

// Events of which the next one is always known.
class EventHeap {
 public:
  EventHeap() { events_.reserve(256); }
  bool empty() const { return events_.empty(); }
  // Requires, of these: it is not empty.
  const FiledEvent& front() const { return events_.front(); }
  FiledEvent take();
  void push(const FiledEvent& event);

 private:
  std::vector<FiledEvent> events_;  // the next event is at the front
};

// Something that will happen. The meaning of `payload` and `stamp` depends on the kind. If the stamp no longer matches,
// the event is stale and nothing happens.
struct Event {
  enum class Kind : std::uint8_t {
    Start,
    OrderReleased,
    OrderWithdrawn,
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
  // An event of the kind MessageArrives in the lane.
  struct Arrival {
    SimTime at;
    EventOrder order;
    std::uint32_t payload;
    AgvId receiver() const { return order.agv(); }
  };
  // An event of the kind TimerGoesOff in the row.
  struct Timer {
    SimTime at;
    AgvId agv;
    std::uint32_t number;
    std::uint64_t stamp;
  };

  void push(SimTime at, EntityId entity, Event::Kind kind, std::uint64_t payload = 0, std::uint64_t stamp = 0);
  // The same for an event of the kind TimerGoesOff, with its number as payload.
  void push_timer(SimTime at, AgvId agv, std::uint32_t number, std::uint64_t stamp) {
    file<true>({at, EventOrder::of_agv(agv, sequence_++), stamp, with_kind(number, Event::Kind::TimerGoesOff)});
  }
  // The same for an event of the kind MessageArrives at each of these, one after the other.
  void push_arrivals(SimTime at, std::span<const AgvId> receivers, std::uint32_t payload);
  // The same for arrivals that are found one by one. Room for so many in the lane, or null if they must be pushed one
  // by one; each of them; and how many have been written there.
  Arrival* room_in_lane(SimTime at, std::size_t arrivals) {
    return goes_into_lane(at) ? lane_.room_for(arrivals) : nullptr;
  }
  Arrival arrival(SimTime at, AgvId receiver, std::uint32_t payload) {
    return {at, EventOrder::of_agv(receiver, sequence_++), payload};
  }
  void stand_in_lane(std::size_t arrivals) { lane_.added(arrivals); }

  bool empty() const { return lane_.empty() && first_filed_.order == EventOrder{}; }
  // Takes the next event, if it is at or before `end`; else false.
  bool pop_until(SimTime end, Event& event);
  // Requires: there is an event.
  Event pop();

  // The same in two steps. It costs less, because an arrival or a timer does not become an event.
  // Whether the next event is an arrival in the lane. The arrivals of one instant are sorted when the run reaches that
  // instant. While some of them are left, no further one joins them.
  bool arrival_comes_first() {
    if (lane_.empty() || first_filed_.at < lane_.front().at) return false;
    if (opened_ == 0) open_instant();
    return is_before(lane_.front(), first_filed_);
  }
  // If an arrival comes first:
  const Arrival& first_arrival() const { return lane_.front(); }
  void drop_arrival() {
    lane_.drop_front();
    --opened_;
  }
  // If none comes first: whether the next event is a timer in the row.
  bool timer_comes_first() const { return first_filed_.in_row; }
  // If one comes first:
  Timer first_timer() const {
    const auto& [at, order, stamp, number_and_kind] = timers_.front();
    return {at, order.agv(), static_cast<std::uint32_t>(timers_.front().payload()), stamp};
  }
  void drop_timer() {
    timers_.drop_front();
    find_first_filed();
  }
  // If no arrival comes first: as `pop_until`.
  bool pop_filed_until(SimTime end, Event& event) {
    if (first_filed_.at > end || first_filed_.order == EventOrder{}) return false;
    take_filed(event);
    return true;
  }

 private:
  static constexpr std::uint64_t with_kind(std::uint64_t payload, Event::Kind kind) {
    return payload << FiledEvent::kKindBits | static_cast<std::uint64_t>(kind);
  }
  template <bool kIsTimer>
  void file(const FiledEvent& event) {
    const bool in_row = kIsTimer && (timers_.empty() || is_before(timers_.back(), event));
    if (in_row) {
      *timers_.room_for(1) = event;
      timers_.added(1);
    } else {
      heap_.push(FiledEvent(event));  // a copy, so that a timer in the row is written there only
    }
    if (is_before(event, first_filed_)) first_filed_ = {event.at, event.order, in_row};
  }
  void take_filed(Event& event);
  void find_first_filed();
  void open_instant();
  void put_in_order(std::span<Arrival> instant);
  bool goes_into_lane(SimTime at) const {
    return lane_.empty() || at > lane_.back().at || (at == lane_.back().at && opened_ < lane_.size());
  }

  EventRow<Arrival> lane_;       // in order of time
  std::size_t opened_ = 0;       // so many arrivals at its front are in order; those at one instant are opened together
  EventRow<FiledEvent> timers_;  // in order
  EventHeap heap_;               // all other events
  // Of timers and heap.
  struct First {
    SimTime at = kForever;
    EventOrder order;
    bool in_row = false;
  } first_filed_;
  std::uint64_t sequence_ = 0;
  // Only while an instant is put in order.
  std::vector<std::uint32_t> places_;
  std::vector<Arrival> in_order_;
};

}  // namespace fleetproof
