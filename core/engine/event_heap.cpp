#include "core/engine/event_heap.hpp"

namespace fleetproof {

[[gnu::noinline]] void EventHeap::push(const FiledEvent& event) {
  std::size_t place = events_.size();
  events_.push_back(event);
  while (place > 0) {
    const std::size_t above = (place - 1) / 2;
    if (!is_before(event, events_[above])) break;
    events_[place] = events_[above];
    place = above;
  }
  events_[place] = event;
}

[[gnu::noinline]] FiledEvent EventHeap::take() {
  const FiledEvent first = events_.front(), last = events_.back();
  events_.pop_back();
  if (events_.empty()) return first;
  std::size_t place = 0;
  for (std::size_t below = 1; below < events_.size(); below = 2 * place + 1) {
    if (below + 1 < events_.size() && is_before(events_[below + 1], events_[below])) ++below;
    if (!is_before(events_[below], last)) break;
    events_[place] = events_[below];
    place = below;
  }
  events_[place] = last;
  return first;
}

}  // namespace fleetproof
