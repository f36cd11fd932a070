#include "core/engine/event_queue.hpp"

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

constexpr std::size_t kFirstRoom = 256;  // arrivals

}  // namespace

void EventQueue::push(SimTime at, EntityId entity, Event::Kind kind, std::uint64_t payload, std::uint64_t stamp) {
  const Filed filed{at, order_of(entity, sequence_++), stamp, payload << kKindBits | static_cast<std::uint64_t>(kind)};
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

void EventQueue::push_arrivals(SimTime at, std::span<const EntityId> entities, std::uint32_t payload) {
  if (entities.empty()) return;
  if (!goes_into_lane(at)) {
    for (const EntityId entity : entities) push(at, entity, Event::Kind::MessageArrives, payload);
    return;
  }
  if (lane_end_ + entities.size() > lane_capacity_) make_room(entities.size());
  Arrival* to = lane_.get() + lane_end_;
  for (const EntityId entity : entities) *to++ = {at, order_of(entity, sequence_++), payload};
  lane_end_ += entities.size();
}

// Most of a full lane has been taken, or it becomes twice as long: either is seldom enough to cost nothing.
void EventQueue::make_room(std::size_t arrivals) {
  const std::size_t waiting = lane_end_ - next_;
  std::unique_ptr<Arrival[]> longer;
  if (2 * (waiting + arrivals) > lane_capacity_) {
    lane_capacity_ = std::max(kFirstRoom, 2 * (waiting + arrivals));
    longer = std::make_unique_for_overwrite<Arrival[]>(lane_capacity_);
  }
  std::copy_n(lane_.get() + next_, waiting, longer ? longer.get() : lane_.get());
  if (longer) lane_ = std::move(longer);
  opened_ -= next_;
  lane_end_ = waiting;
  next_ = 0;
}

Event EventQueue::pop() {
  Event event;
  ensure(pop_until(kForever, event), "only a queue that holds events gives one");
  return event;
}

void EventQueue::open_instant() {
  const SimTime at = lane_[next_].at;
  bool in_order = true;
  for (++opened_; opened_ < lane_end_ && lane_[opened_].at == at; ++opened_)
    in_order = in_order && lane_[opened_ - 1].order < lane_[opened_].order;
  if (!in_order) std::ranges::sort(std::span(lane_.get() + next_, opened_ - next_), {}, &Arrival::order);
}

void EventQueue::take_filed(Event& event) {
  const Filed& first = heap_.front();
  const auto entity = static_cast<std::uint32_t>(first.order >> kSequenceBits);
  event.at = first.at;
  event.entity = entity == kNoEntity ? EntityId{} : EntityId{entity};
  event.kind = static_cast<Event::Kind>(first.payload_and_kind & ((1U << kKindBits) - 1));
  event.sequence = sequence_in(first.order);
  event.payload = first.payload_and_kind >> kKindBits;
  event.stamp = first.stamp;
  const Filed last = heap_.back();
  heap_.pop_back();
  if (heap_.empty()) return;
  std::size_t place = 0;
  for (std::size_t below = 1; below < heap_.size(); below = 2 * place + 1) {
    if (below + 1 < heap_.size() && is_before(heap_[below + 1], heap_[below])) ++below;
    if (!is_before(heap_[below], last)) break;
    heap_[place] = heap_[below];
    place = below;
  }
  heap_[place] = last;
}

}  // namespace fleetproof
