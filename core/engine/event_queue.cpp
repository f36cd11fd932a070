#include "core/engine/event_queue.hpp"

#include <algorithm>

namespace fleetproof {

bool EventQueue::later(const Event& a, const Event& b) {
  if (a.at != b.at) return a.at > b.at;
  if (a.entity != b.entity) return a.entity > b.entity;
  return a.sequence > b.sequence;
}

void EventQueue::push(SimTime at, EntityId entity, Event::Kind kind, std::uint64_t payload, std::uint64_t stamp) {
  heap_.push_back({at, entity, kind, sequence_++, payload, stamp});
  std::ranges::push_heap(heap_, later);
}

Event EventQueue::pop() {
  std::ranges::pop_heap(heap_, later);
  const Event event = heap_.back();
  heap_.pop_back();
  return event;
}

}  // namespace fleetproof
