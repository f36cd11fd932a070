#include "core/agents/lock_protocol.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace fleetproof::agents {
namespace {

constexpr double kRounding_m = 1e-6;  // of sums of lengths; the proof of distance has a margin of a metre

// More than a third of the fleet gets one message together. Of repetitions, a STATE to all takes more than a twelfth:
// it tells the others news as well.
constexpr std::size_t kFewerMessages = 3, kFewerRepetitions = 12;
// A STATE is sent at the latest after this time. It is longer in large fleets, so that an AGV hears about as many of
// them a second.
constexpr double kQuiet_s = 1.0, kQuietPerAgv_s = 0.05, kLongestQuiet_s = 30.0;

}  // namespace

void LockProtocol::stand(const Path& standing) {
  held_ = standing;
  ++held_version_;
  way_.replace(end_of(map_, held_), transmitter_.begin_new_stamp());
}

bool LockProtocol::request(const Path& stretch, std::int64_t demand_ns, std::span<const std::uint32_t> onward) {
  if (!continues_held(stretch)) {
    withdraw();
    return false;
  }
  request_ = stretch;
  request_.heading = end_of(map_, held_).heading;
  ++request_version_;
  demand_ns_ = demand_ns;
  requesting_ = true;
  announce(onward);
  open_epoch();
  return true;
}

// As far as the messages have room.
void LockProtocol::announce(std::span<const std::uint32_t> onward) {
  Path way = request_;
  for (const std::uint32_t lane : onward) {
    if (held_.count + way.count < kPathLanesMax) way.append(lane);
  }
  way_.replace(way, transmitter_.begin_new_stamp());
}

bool LockProtocol::continues_held(const Path& stretch) const {
  const double claim_m = length_m(map_, held_) + length_m(map_, stretch);
  return stretch.station == end_of(map_, held_).station && is_driveable(map_, stretch) &&
         stretch.count <= kPathLanesMax - held_.count && claim_m <= neighbours_.claim_limit_m() + kRounding_m;
}

void LockProtocol::open_epoch() {
  epoch_ = next_request(epoch_);
  if (!options_.consent.epochs_grow && number_of(epoch_) >= 256 * kAttempts) {
    controller_.sometimes("number-wrapped");
    epoch_ = first_epoch(boot_of(epoch_));
  }
  asked_ = false;
  look_at_all_ = true;
  repeated_grants_ = 0;
  answers_may_change_ = true;
  blocker_.forget();
}

void LockProtocol::withdraw() {
  requesting_ = false;
  answers_may_change_ = true;
  blocker_.forget();
  controller_.waiting_for(FP_NONE);
}

void LockProtocol::know_own_place(bool known) {
  own_place_known_ = known;
  answers_may_change_ = true;
}

void LockProtocol::lane_passed() {
  if (held_.empty()) return;
  pass_first_lane(map_, held_);
  ++held_version_;
  answers_may_change_ = true;
}

bool LockProtocol::receive(std::uint32_t sender, std::span<const std::byte> bytes) {
  const std::optional<Message> message = decode(bytes);
  if (!message) return false;
  const Neighbours::News news = neighbours_.note(sender, *message, controller_.now_ns());
  if (news == Neighbours::News::Refused) return false;
  if (news == Neighbours::News::Changed) {
    changed_.push_back(sender);
    if (requesting_ && blocker_.look_at(sender, request_)) answers_may_change_ = true;
  }
  if (message->has_request()) receive_request(sender, *message);
  switch (message->kind) {
    case MessageKind::State:
      controller_.believe(sender, message->status.position_m, std::int64_t{message->status.stamp_ms} * 1'000'000);
      for (const Answers::Answer& answer : message->answers.all()) {
        if (answer.agv == neighbours_.self()) receive_answer(sender, answer.echo, answer.granted);
      }
      break;
    case MessageKind::Request:
      break;
    case MessageKind::Grant:
    case MessageKind::Defer:
      receive_answer(sender, message->echo, message->kind == MessageKind::Grant);
      break;
  }
  note_consent(sender);
  return true;
}

void LockProtocol::receive_request(std::uint32_t sender, const Message& message) {
  const Neighbour& n = neighbours_.of(sender);
  const Asked::Entry* const us = message.asked.of(neighbours_.self());
  if (us != nullptr && message.status.epoch + us->attempt == n.request_epoch && n.request_is_open())
    answer_request(sender);
}

void LockProtocol::answer_request(std::uint32_t sender) {
  Neighbour& n = neighbours_.of(sender);
  if (has_granted(n)) {  // the grant was lost or is still under way; the next STATE repeats it
    controller_.sometimes("grant-lost");
    return;
  }
  const Answer answer = answer_to(sender, n);
  if (answer != Answer::Defer) return grant(sender, n, answer);
  if (n.deferred_epoch == n.request_epoch) return;
  controller_.sometimes("deferred");
  n.deferred_epoch = n.request_epoch;
  n.answer_repeats = {};
  send_answer(MessageKind::Defer, sender, n.request_epoch);
}

bool LockProtocol::has_granted(const Neighbour& n) const {
  return options_.grants.grants_name_epoch ? n.granted_epoch == n.request_epoch : n.granted_epoch > 0;
}

LockProtocol::Answer LockProtocol::answer_to(std::uint32_t agv, Neighbour& neighbour) {
  if (!own_place_known_) return options_.grants.unknown_place_defers ? Answer::Defer : Answer::Grant;
  if (!lock_is_over() && neighbours_.clashes(agv, neighbour.with_held, held_, held_version_)) return Answer::Defer;
  if (!requesting_ || !neighbours_.clashes(agv, neighbour.with_request, request_, request_version_))
    return Answer::Grant;
  return comes_first(agv, neighbour) ? Answer::Defer : Answer::GrantAndStepBack;
}

bool LockProtocol::lock_is_over() {
  if (!options_.grants.bodies_count && held_.empty()) return true;
  return options_.grants.locks_end_after_ns > 0 &&
         controller_.now_ns() - locked_at_ns_ > options_.grants.locks_end_after_ns;
}

bool LockProtocol::comes_first(std::uint32_t agv, const Neighbour& neighbour) {
  if (!options_.progress.order_is_common) return false;
  // A blocked request cannot be locked before another AGV moves. It must not stop that AGV, or the AGVs for which that
  // AGV waits. Both sides must find the same order; otherwise two requests would step back from each other for ever.
  // Therefore every message contains `blocked`.
  const bool mine_blocked = requesting_ && blocker_.is_inside(request_);
  const bool other_blocked = neighbour.status.blocked;
  const std::uint32_t self = options_.progress.smaller_number_first ? neighbours_.self() : agv;
  return std::tie(mine_blocked, demand_ns_, self) < std::tie(other_blocked, neighbour.demand_ns, agv);
}

void LockProtocol::grant(std::uint32_t agv, Neighbour& neighbour, Answer answer) {
  neighbour.granted_epoch = neighbour.request_epoch;
  neighbour.answer_repeats = {};
  if (answer == Answer::GrantAndStepBack) {
    controller_.sometimes("overtaken");
    give_way_to(neighbour);
  }
  send_answer(MessageKind::Grant, agv, neighbour.request_epoch);
}

// The other AGV is asked again when it is time to repeat. If each asked at once over a radio without delay, AGVs that
// want the same floor would let each other pass without end at one instant.
void LockProtocol::give_way_to(Neighbour& neighbour) {
  const bool granted = has_consent(neighbour);
  if (options_.grants.overtaken == Overtaken::DropsThatGrant) neighbour.granted_us_epoch = 0;
  const bool steps_back = options_.grants.overtaken == Overtaken::StepsBack ||
                          (options_.grants.overtaken == Overtaken::StepsBackIfGranted && granted);
  if (!steps_back) return;
  if (!is_asked(neighbour)) neighbour.asked_epoch = epoch_;  // it may have granted that one without being asked
  if (request_of(neighbour.asked_epoch + 1) != epoch_) return open_epoch();
  ++neighbour.asked_epoch;
  neighbour.request_repeats = {};
  neighbour.silent_since_ns = controller_.now_ns();
  look_at_all_ = true;
}

void LockProtocol::answer_those_deferred() {
  std::ranges::sort(changed_);
  if (std::exchange(answers_may_change_, false)) {  // an answer may change it again
    neighbours_.for_each([&](std::uint32_t agv, Neighbour&) { answer_if_asked(agv); });
  } else {
    for (const std::uint32_t agv : changed_) answer_if_asked(agv);
  }
  changed_.clear();
}

void LockProtocol::answer_if_asked(std::uint32_t agv) {
  Neighbour& n = neighbours_.of(agv);
  if (!n.request_is_open() || !n.asks_us || n.granted_epoch == n.request_epoch) return;
  const Answer answer = answer_to(agv, n);
  if (answer != Answer::Defer) grant(agv, n, answer);
}

void LockProtocol::receive_answer(std::uint32_t sender, Epoch echo, bool granted) {
  Neighbour& n = neighbours_.of(sender);
  if (!is_asked(n) || (options_.consent.answers_name_epoch && echo != n.asked_epoch)) {
    if (granted && requesting_) controller_.sometimes("late-grant");
    return;
  }
  if (granted) {
    if (has_consent(n)) ++repeated_grants_;
    n.granted_us_epoch = n.asked_epoch;
  } else {
    n.silent_since_ns = controller_.now_ns();
    n.deferred_us_epoch = n.asked_epoch;
    controller_.waiting_for(sender);
  }
}

bool LockProtocol::settle() {
  answer_those_deferred();
  if (!requesting_ || !own_place_known_ || !all_consent()) return false;
  for (const std::uint32_t lane : request_.lanes()) held_.append(lane);
  ++held_version_;
  way_.shorten(map_, request_.count);
  if (options_.grants.locks_end_after_ns > 0) locked_at_ns_ = controller_.now_ns();
  withdraw();
  return true;
}

// Whose consent was missing at the last look at all AGVs can only give it by a message. Whether the others still
// consent matters when no consent is missing any more; `broadcast_state` orders a look from time to time, too.
bool LockProtocol::all_consent() {
  if (!look_at_all_ && options_.consent.senders_count && options_.consent.silence_consents_after_ns == 0) return false;
  look_at_all_ = false;
  const std::int64_t now_ns = controller_.now_ns();
  const bool first = !asked_;
  missing_ = 0;
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    n.is_missing = !consents(agv, n, now_ns);
    if (!n.is_missing) return;
    ++missing_;
    if (is_asked(n)) return;
    if (!first) controller_.sometimes("newcomer");
    n.asked_epoch = epoch_;
    n.silent_since_ns = now_ns;
    n.request_repeats = {};
    to_ask_.push_back(agv);
  });
  if (first && missing_ == 0) controller_.sometimes("unasked");
  if (first && !to_ask_.empty()) controller_.sometimes("negotiation");
  asked_ = true;
  ask();
  return missing_ == 0 || (!options_.consent.senders_count && missing_ <= repeated_grants_);
}

void LockProtocol::note_consent(std::uint32_t agv) {
  Neighbour& n = neighbours_.of(agv);
  if (!is_asked(n) || !n.is_missing || !consents(agv, n, controller_.now_ns())) return;
  n.is_missing = false;
  look_at_all_ = --missing_ == 0;
}

bool LockProtocol::consents(std::uint32_t agv, const Neighbour& neighbour, std::int64_t now_ns) {
  if (has_consent(neighbour)) return true;
  if (options_.consent.silence_consents_after_ns > 0 && is_asked(neighbour) &&
      now_ns - neighbour.silent_since_ns >= options_.consent.silence_consents_after_ns) {
    controller_.sometimes("silence-taken-for-consent");
    return true;
  }
  return knows_request(neighbour) &&
         (neighbours_.surely_beyond(agv, request_, now_ns) || neighbours_.is_apart(agv, request_, epoch_));
}

// ---- what it says

// One message to all if it has enough addressees: it is one transmission.
void LockProtocol::ask() {
  if (to_ask_.size() * kFewerMessages <= neighbours_.fleet_count()) {
    for (const std::uint32_t agv : to_ask_) send_request(agv);
  } else {
    Message message = request_message();
    for (const std::uint32_t agv : to_ask_) {
      if (message.asked.add(entry_of(agv))) continue;
      transmitter_.send(message, FP_NONE);
      message.asked = {};
      message.asked.add(entry_of(agv));
    }
    transmitter_.send(message, FP_NONE);
  }
  to_ask_.clear();
}

// What a REQUEST says to this AGV.
Asked::Entry LockProtocol::entry_of(std::uint32_t agv) const {
  return {agv, static_cast<std::uint32_t>(neighbours_.of(agv).asked_epoch - epoch_)};
}

// Few repetitions go to their addressees, many go out with the STATE.
void LockProtocol::repeat() {
  look_at_all_ = true;
  due_.clear();
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    const bool request = options_.progress.asks_again && is_unanswered(n) && n.request_repeats.is_due();
    const bool answer = owes_answer(n) && (has_granted(n) || !n.knows_defer) && n.answer_repeats.is_due();
    if (request || answer) due_.push_back({agv, request, answer});
  });
  if (std::any_of(due_.begin(), due_.end(), [](const Due& due) { return due.request; }))
    controller_.sometimes("retransmission");
  const double quiet_s = static_cast<double>(controller_.now_ns() - state_sent_ns_) * 1e-9;
  const bool many = due_.size() > 1 && due_.size() * kFewerRepetitions > neighbours_.fleet_count();
  if (many || quiet_s > longest_quiet_s() || state_sent_ns_ < 0) return broadcast_state();
  for (const Due& due : due_) {
    const Neighbour& n = neighbours_.of(due.agv);
    if (due.request) send_request(due.agv);
    if (due.answer) send_answer(has_granted(n) ? MessageKind::Grant : MessageKind::Defer, due.agv, n.request_epoch);
  }
}

double LockProtocol::longest_quiet_s() const {
  return std::clamp(kQuietPerAgv_s * neighbours_.fleet_count(), kQuiet_s, kLongestQuiet_s);
}

void LockProtocol::broadcast_state() {
  state_sent_ns_ = controller_.now_ns();
  Message message;
  fill_in(message.status);
  neighbours_.tell_heard_from(message.heard);
  if (requesting_) fill_in_request(message);
  fill_in_lists(message);
  transmitter_.send(message, FP_NONE);
}

// The next STATE begins with those that this one has no room for.
void LockProtocol::fill_in_lists(Message& message) {
  std::uint32_t left_out = FP_NONE;
  const auto say = [&](std::uint32_t agv, bool fits) {
    if (!fits && left_out == FP_NONE) left_out = agv;
  };
  neighbours_.for_each_from(first_in_lists_, [&](std::uint32_t agv, const Neighbour& n) {
    if (options_.progress.asks_again && is_unanswered(n)) say(agv, message.asked.add(entry_of(agv)));
    if (owes_answer(n)) say(agv, message.answers.add({agv, n.request_epoch, has_granted(n)}));
  });
  neighbours_.for_each_from(first_in_lists_, [&](std::uint32_t agv, const Neighbour& n) {
    const bool has_deferred = is_asked(n) && !has_consent(n) && n.deferred_us_epoch == n.asked_epoch;
    if (has_deferred) say(agv, message.asked.add(entry_of(agv), true));
  });
  if (left_out != FP_NONE) first_in_lists_ = left_out;
}

void LockProtocol::send_answer(MessageKind kind, std::uint32_t receiver, Epoch echo) {
  Message message;
  message.kind = kind;
  fill_in(message.status);
  neighbours_.tell_heard_from(message.heard, receiver);
  message.echo = echo;
  transmitter_.send(message, receiver);
}

void LockProtocol::send_request(std::uint32_t receiver) {
  Message message = request_message();
  message.asked.add(entry_of(receiver));
  neighbours_.tell_heard_from(message.heard, receiver);
  transmitter_.send(message, receiver);
}

Message LockProtocol::request_message() {
  Message message;
  message.kind = MessageKind::Request;
  fill_in(message.status);
  fill_in_request(message);
  return message;
}

void LockProtocol::fill_in_request(Message& message) {
  message.demand_ns = demand_ns_;
  message.request = request_;
}

void LockProtocol::fill_in(Status& status) {
  transmitter_.fill_in(status);
  status.epoch = epoch_;
  status.requesting = requesting_;
  status.blocked = requesting_ && blocker_.is_inside(request_);
  status.held = held_;
  status.ahead = way_.path();
}

}  // namespace fleetproof::agents
