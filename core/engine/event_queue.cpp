#include "core/engine/event_queue.hpp"

#include <numeric>

#include "core/base/error.hpp"

namespace fleetproof {

// ---- filed events

void EventQueue::push(SimTime at, EntityId entity, Event::Kind kind, std::uint64_t payload, std::uint64_t stamp) {
  const Filed filed{at, order_of(entity, sequence_++), stamp, payload << kKindBits | static_cast<std::uint64_t>(kind)};
  const bool in_row = kind == Event::Kind::TimerGoesOff && (timers_.empty() || is_before(timers_.back(), filed));
  if (in_row) {
    *timers_.room_for(1) = filed;
    timers_.added(1);
  } else {
    push_on_heap(filed);
  }
  if (at > filed_at_ || (at == filed_at_ && filed.order > filed_order_)) return;
  filed_at_ = at;
  filed_order_ = filed.order;
  filed_in_row_ = in_row;
}

void EventQueue::push_on_heap(const Filed& filed) {
  std::size_t place = heap_.size();
  heap_.push_back(filed);
  while (place > 0) {
    const std::size_t above = (place - 1) / 2;
    if (!is_before(filed, heap_[above])) break;
    heap_[place] = heap_[above];
    place = above;
  }
  heap_[place] = filed;
}

EventQueue::Filed EventQueue::take_from_heap() {
  const Filed first = heap_.front(), last = heap_.back();
  heap_.pop_back();
  if (heap_.empty()) return first;
  std::size_t place = 0;
  for (std::size_t below = 1; below < heap_.size(); below = 2 * place + 1) {
    if (below + 1 < heap_.size() && is_before(heap_[below + 1], heap_[below])) ++below;
    if (!is_before(heap_[below], last)) break;
    heap_[place] = heap_[below];
    place = below;
  }
  heap_[place] = last;
  return first;
}

void EventQueue::take_filed(Event& event) {
  const Filed first = filed_in_row_ ? timers_.front() : take_from_heap();
  if (filed_in_row_) timers_.drop_front();
  find_first_filed();
  const auto entity = static_cast<std::uint32_t>(first.order >> kSequenceBits);
  event.at = first.at;
  event.entity = entity == kNoEntity ? EntityId{} : EntityId{entity};
  event.kind = static_cast<Event::Kind>(first.payload_and_kind & ((1U << kKindBits) - 1));
  event.sequence = sequence_in(first.order);
  event.payload = first.payload_and_kind >> kKindBits;
  event.stamp = first.stamp;
}

void EventQueue::find_first_filed() {
  filed_in_row_ = !timers_.empty() && (heap_.empty() || is_before(timers_.front(), heap_.front()));
  const Filed* first = filed_in_row_ ? &timers_.front() : heap_.empty() ? nullptr : &heap_.front();
  filed_at_ = first != nullptr ? first->at : kForever;
  filed_order_ = first != nullptr ? first->order : kNothing;
}

// ---- arrivals

void EventQueue::push_arrivals(SimTime at, std::span<const EntityId> entities, std::uint32_t payload) {
  Arrival* const room = room_in_lane(at, entities.size());
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (room != nullptr) {
      room[i] = arrival(at, entities[i], payload);
    } else {
      push(at, entities[i], Event::Kind::MessageArrives, payload);
    }
  }
  if (room != nullptr) stand_in_lane(entities.size());
}

void EventQueue::open_instant() {
  const std::span<Arrival> lane(lane_.begin(), lane_.size());
  bool in_order = true;
  for (opened_ = 1; opened_ < lane.size() && lane[opened_].at == lane.front().at; ++opened_)
    in_order = in_order && lane[opened_ - 1].order < lane[opened_].order;
  if (!in_order) put_in_order(lane.first(opened_));
}

// They stand in order of sequence. Many of few receivers are counted by receiver instead of sorted.
void EventQueue::put_in_order(std::span<Arrival> instant) {
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
  event = {first.at, first.receiver(), Event::Kind::MessageArrives, sequence_in(first.order), first.payload, 0};
  return true;
}

Event EventQueue::pop() {
  Event event;
  ensure(pop_until(kForever, event), "only a queue that holds events gives one");
  return event;
}

}  // namespace fleetproof
