#include "core/engine/event_queue.hpp"

#include <numeric>

#include "core/base/error.hpp"

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

// ---- filed events

void EventQueue::push(SimTime at, EntityId entity, Event::Kind kind, std::uint64_t payload, std::uint64_t stamp) {
  const FiledEvent event{at, {entity, sequence_++}, stamp, with_kind(payload, kind)};
  if (kind == Event::Kind::TimerGoesOff) {
    file<true>(event);
  } else {
    file<false>(event);
  }
}

[[gnu::noinline]] void EventQueue::take_filed(Event& event) {
  const FiledEvent first = first_filed_.in_row ? timers_.front() : heap_.take();
  if (first_filed_.in_row) timers_.drop_front();
  find_first_filed();
  event.at = first.at;
  event.entity = first.order.entity();
  event.kind = static_cast<Event::Kind>(first.payload_and_kind & ((1U << FiledEvent::kKindBits) - 1));
  event.sequence = first.order.sequence();
  event.payload = first.payload();
  event.stamp = first.stamp;
}

void EventQueue::find_first_filed() {
  const bool in_row = !timers_.empty() && (heap_.empty() || is_before(timers_.front(), heap_.front()));
  if (!in_row && heap_.empty()) {
    first_filed_ = {};
    return;
  }
  const FiledEvent& first = in_row ? timers_.front() : heap_.front();
  first_filed_.at = first.at;
  first_filed_.order = first.order;
  first_filed_.in_row = in_row;
}

// ---- arrivals

void EventQueue::push_arrivals(SimTime at, std::span<const AgvId> receivers, std::uint32_t payload) {
  Arrival* const room = room_in_lane(at, receivers.size());
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    if (room != nullptr) {
      room[i] = arrival(at, receivers[i], payload);
    } else {
      push(at, receivers[i], Event::Kind::MessageArrives, payload);
    }
  }
  if (room != nullptr) stand_in_lane(receivers.size());
}

void EventQueue::open_instant() {
  const std::span<Arrival> lane(lane_.begin(), lane_.size());
  bool in_order = true;
  for (opened_ = 1; opened_ < lane.size() && lane[opened_].at == lane.front().at; ++opened_)
    in_order = in_order && lane[opened_ - 1].order < lane[opened_].order;
  if (!in_order) put_in_order(lane.first(opened_));
}

// They stand in order of sequence. Many of few receivers are counted by receiver instead of sorted.
[[gnu::noinline]] void EventQueue::put_in_order(std::span<Arrival> instant) {
  constexpr std::size_t kFew = 24;
  std::uint32_t receivers = 0;
  for (const Arrival& arrival : instant) receivers = std::max(receivers, arrival.receiver().value + 1);
  if (instant.size() < kFew || receivers > 2 * instant.size()) {
    std::ranges::sort(instant, {}, &Arrival::order);
    return;
  }
  places_.assign(receivers + 1, 0);
  for (const Arrival& arrival : instant) ++places_[arrival.receiver().value + 1];
  std::partial_sum(places_.begin(), places_.end(), places_.begin());  // by receiver: where its first arrival will stand
  in_order_.assign(instant.begin(), instant.end());
  for (const Arrival& arrival : in_order_) instant[places_[arrival.receiver().value]++] = arrival;
}

// ---- both

bool EventQueue::pop_until(SimTime end, Event& event) {
  if (!arrival_comes_first()) return pop_filed_until(end, event);
  const Arrival first = first_arrival();
  if (first.at > end) return false;
  drop_arrival();
  event = {first.at, first.receiver(), Event::Kind::MessageArrives, first.order.sequence(), first.payload, 0};
  return true;
}

Event EventQueue::pop() {
  Event event;
  ensure(pop_until(kForever, event), "only a queue that holds events gives one");
  return event;
}

}  // namespace fleetproof
