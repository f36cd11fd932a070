#include "core/agents/lock_messages.hpp"

#include <algorithm>
#include <cmath>

namespace fleetproof::agents {
namespace {

// More than a third of the fleet gets one message together.
constexpr std::size_t kFewerMessages = 3;
// In a fleet that is divided into zones, how long after the last message to an AGV another one follows: at the latest,
// if it does not know the newest way, and if there is other news for it. Longer, with more AGVs around than a few.
constexpr double kQuiet_ns = 5e9, kTellsAgain_ns = 3e9, kTellsNews_ns = 1e9;
constexpr std::size_t kFewAround = 7;

}  // namespace

void LockMessages::ask(std::span<const std::uint32_t> agvs) {
  if (agvs.size() * kFewerMessages <= neighbours_.fleet_count()) {
    for (const std::uint32_t agv : agvs) send_request(agv);
    return;
  }
  Message message = begin(MessageKind::Request);
  fill_in_request(message);
  for (const std::uint32_t agv : agvs) {
    const Asked::Entry entry = claim_.entry_for(agv, neighbours_.of(agv));
    if (message.asked.add(entry)) continue;
    transmitter_.send(message, FP_NONE);
    message.asked = {};
    message.asked.add(entry);
  }
  transmitter_.send(message, FP_NONE);
}

void LockMessages::send_request(std::uint32_t receiver) {
  Message message = begin(MessageKind::Request);
  fill_in_request(message);
  message.asked.add(claim_.entry_for(receiver, neighbours_.of(receiver)));
  send_to(receiver, message);
}

void LockMessages::send_answer(MessageKind kind, std::uint32_t receiver) {
  Message message = begin(kind);
  message.echo = neighbours_.of(receiver).request_epoch;
  send_to(receiver, message);
}

void LockMessages::broadcast_state() {
  state_sent_ns_ = controller_.now_ns();
  Message message = begin(MessageKind::State);
  if (message.tells_zones) neighbours_.for_each([&](std::uint32_t, Neighbour& n) { note_told(n, message); });
  neighbours_.tell_heard_from(message.heard);
  if (claim_.requesting) fill_in_request(message);
  fill_in_lists(message);
  transmitter_.send(message, FP_NONE);
}

double LockMessages::quiet_s() const {
  return state_sent_ns_ < 0 ? INFINITY : static_cast<double>(controller_.now_ns() - state_sent_ns_) * 1e-9;
}

// The next STATE begins with those that this one has no room for. A message that tells zones has no room for answers.
void LockMessages::fill_in_lists(Message& message) {
  std::uint32_t left_out = FP_NONE;
  const auto say = [&](std::uint32_t agv, bool fits) {
    if (!fits && left_out == FP_NONE) left_out = agv;
  };
  neighbours_.for_each_from(first_in_lists_, [&](std::uint32_t agv, const Neighbour& n) {
    if (asks_again_ && claim_.is_unanswered(n)) say(agv, message.asked.add(claim_.entry_for(agv, n)));
    if (claim_.owes_answer(n) && !message.tells_zones)
      say(agv, message.answers.add({agv, n.request_epoch, claim_.has_granted(n)}));
  });
  neighbours_.for_each_from(first_in_lists_, [&](std::uint32_t agv, const Neighbour& n) {
    if (claim_.has_deferred(n)) say(agv, message.asked.add(claim_.entry_for(agv, n), true));
  });
  if (left_out != FP_NONE) first_in_lists_ = left_out;
}

void LockMessages::tell(std::uint32_t receiver, bool wants_answer) {
  const Neighbour& n = neighbours_.of(receiver);
  Message message = begin(MessageKind::State);
  message.wants_answer = wants_answer;
  if (claim_.requesting) {
    fill_in_request(message);
    if (asks_again_ && claim_.is_unanswered(n)) message.asked.add(claim_.entry_for(receiver, n));
    if (claim_.has_deferred(n)) message.asked.add(claim_.entry_for(receiver, n), true);
  }
  if (claim_.owes_answer(n)) message.answers.add({receiver, n.request_epoch, claim_.has_granted(n)});
  send_to(receiver, message);
}

bool LockMessages::is_to_be_told(const Neighbour& n, std::int64_t now_ns) {
  if (n.told_at_ns < 0) return true;
  const double many = static_cast<double>(std::max(kFewAround, neighbours_.audience().agvs().size())) / kFewAround;
  const double since_ns = static_cast<double>(now_ns - n.told_at_ns) / many;
  if (since_ns < kTellsNews_ns || since_ns >= kQuiet_ns) return since_ns >= kQuiet_ns;
  const bool knows_way = n.heard_us_ms >= claim_.way.since_ms(claim_.way.path().count);
  return (!knows_way && since_ns >= kTellsAgain_ns) || n.owes_acknowledgement ||
         n.told_condition != transmitter_.condition(is_blocked(), is_held_up());
}

Message LockMessages::begin(MessageKind kind) {
  Message message;
  message.kind = kind;
  Status& status = message.status;
  transmitter_.fill_in(status);
  status.epoch = claim_.epoch;
  status.requesting = claim_.requesting;
  status.blocked = is_blocked();
  status.held_up = is_held_up();
  status.place_unknown = !claim_.knows_place;
  status.held = claim_.held;
  status.ahead = claim_.way.path();
  message.tells_zones = neighbours_.audience().is_divided();
  if (message.tells_zones) message.zones = neighbours_.audience().own_zones();
  return message;
}

void LockMessages::fill_in_request(Message& message) const {
  message.demand_ns = claim_.demand_ns;
  message.request = claim_.request;
}

void LockMessages::send_to(std::uint32_t receiver, Message& message) {
  neighbours_.tell_heard_from(message.heard, receiver);
  note_told(neighbours_.of(receiver), message);
  transmitter_.send(message, receiver);
}

void LockMessages::note_told(Neighbour& n, const Message& message) {
  n.told_at_ns = controller_.now_ns();
  n.told_condition = transmitter_.condition(message.status.blocked, message.status.held_up);
  n.owes_acknowledgement = false;
}

}  // namespace fleetproof::agents
