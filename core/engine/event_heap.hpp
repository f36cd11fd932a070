#pragma once

#include <cstdint>
#include <vector>

#include "core/base/sim_time.hpp"
#include "core/engine/event_order.hpp"

namespace fleetproof {

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

}  // namespace fleetproof
