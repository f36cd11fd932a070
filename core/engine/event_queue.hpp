#pragma once

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
class EventQueue {
 public:
  EventQueue() { heap_.reserve(256); }

  void push(SimTime at, EntityId entity, Event::Kind kind, std::uint64_t payload = 0, std::uint64_t stamp = 0);
  bool empty() const { return heap_.empty(); }
  SimTime next_at() const { return heap_.front().at; }
  Event pop();

 private:
  static bool later(const Event& a, const Event& b);

  std::vector<Event> heap_;
  std::uint64_t sequence_ = 0;
};

}  // namespace fleetproof
