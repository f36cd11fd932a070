#include "core/engine/contacts.hpp"

#include <algorithm>

#include "core/engine/operator_actions.hpp"

namespace fleetproof {

Contacts::Contacts(RunContext& run, const Ports& ports) : run_(run), ports_(ports) {}

void Contacts::predict(EntityId body) {
  const std::size_t before = predictions_.size();
  run_.world.predict_touches(body, predictions_);
  for (std::size_t i = before; i < predictions_.size(); ++i)
    run_.queue.push(predictions_[i].at, predictions_[i].a, Event::Kind::Contact, i);
}

bool Contacts::is_current(const TouchPrediction& touch) const {
  const Body &a = run_.world.body(touch.a), &b = run_.world.body(touch.b);
  return a.on_floor && b.on_floor && a.piece.number == touch.piece_a && b.piece.number == touch.piece_b;
}

bool Contacts::foresees(EntityId one, EntityId other) const {
  return std::ranges::any_of(predictions_, [&](const TouchPrediction& touch) {
    const bool of_these = (touch.a == one && touch.b == other) || (touch.a == other && touch.b == one);
    return of_these && is_current(touch) && !run_.world.have_touched(one, other);
  });
}

void Contacts::bodies_touch(std::uint64_t prediction) {
  const TouchPrediction touch = predictions_[prediction];
  if (!is_current(touch) || run_.world.have_touched(touch.a, touch.b)) return;
  run_.world.remember_touch(touch.a, touch.b);
  ++run_.counters.contacts;
  run_.trace(touch.a, traced::Contact{touch.b});
  if (!run_.scenario.contact_stops) return;
  stop(touch.a);
  stop(touch.b);
}

void Contacts::stop(EntityId body) {
  if (run_.world.body(body).is_agv && ports_.actions.stop_for_good(body))
    ports_.operator_actions.call(body, Assist::Contact, 0);
}

}  // namespace fleetproof
