#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"

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
// late. These stand in a lane, one behind the other; all other events are in a heap.
class EventQueue {
 public:
  // Requires of every entity: it is below kNoEntity, or invalid.
  static constexpr std::uint32_t kNoEntity = 0xffffff;

  EventQueue() { heap_.reserve(256); }

  void push(SimTime at, EntityId entity, Event::Kind kind, std::uint64_t payload = 0, std::uint64_t stamp = 0);
  // The same for an event of the kind MessageArrives at each of these, one after the other.
  void push_arrivals(SimTime at, std::span<const EntityId> entities, std::uint32_t payload);
  bool empty() const { return heap_.empty() && lane_is_empty(); }
  // Takes the next event, if it is at or before `end`; else false.
  bool pop_until(SimTime end, Event& event) {
    if (lane_comes_first()) {
      if (lane_[next_].at > end) return false;
      take_arrival(event);
    } else {
      if (heap_.empty() || heap_.front().at > end) return false;
      take_filed(event);
    }
    return true;
  }
  // Requires: there is an event.
  Event pop();

 private:
  // Entity and sequence in one number, which compares as they do.
  static constexpr unsigned kSequenceBits = 40, kKindBits = 8;
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
  struct Arrival {
    SimTime at;
    std::uint64_t order;
    std::uint32_t payload;
  };
  template <class One, class Other>
  static bool is_before(const One& one, const Other& other) {
    return one.at != other.at ? one.at < other.at : one.order < other.order;
  }

  bool lane_is_empty() const { return next_ == lane_end_; }
  // Whether the next event stands in the lane. Arrivals of an instant are put in order when it is their turn: by then,
  // none can be added to them.
  bool lane_comes_first() {
    if (lane_is_empty() || (!heap_.empty() && heap_.front().at < lane_[next_].at)) return false;
    if (next_ == opened_) open_instant();
    return heap_.empty() || is_before(lane_[next_], heap_.front());
  }
  void take_arrival(Event& event) {
    const Arrival& first = lane_[next_++];
    event.at = first.at;
    event.entity = EntityId{static_cast<std::uint32_t>(first.order >> kSequenceBits)};
    event.kind = Event::Kind::MessageArrives;
    event.sequence = sequence_in(first.order);
    event.payload = first.payload;
    event.stamp = 0;
    if (lane_is_empty()) next_ = opened_ = lane_end_ = 0;
  }
  void take_filed(Event& event);
  void open_instant();
  bool goes_into_lane(SimTime at) const {
    return lane_is_empty() || at > lane_[lane_end_ - 1].at || (at == lane_[lane_end_ - 1].at && opened_ < lane_end_);
  }
  void make_room(std::size_t arrivals);

  std::vector<Filed> heap_;          // the next event is at the front
  std::unique_ptr<Arrival[]> lane_;  // from next_ to lane_end_, in order of time
  std::size_t next_ = 0, lane_end_ = 0, lane_capacity_ = 0;
  std::size_t opened_ = 0;  // up to here the lane is in order; the arrivals at one instant are opened together
  std::uint64_t sequence_ = 0;
};

}  // namespace fleetproof
