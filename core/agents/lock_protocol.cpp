#include "core/agents/lock_protocol.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace fleetproof::agents {
namespace {

constexpr double kClaimRounding_m = 1e-6;  // of sums of lengths; the proof of distance has a margin of a metre

// Of repetitions, a STATE to all takes more than a twelfth: it tells the others news as well. It is sent at the latest
// after a time that is longer in large fleets, so that an AGV hears about as many of them a second.
constexpr std::size_t kFewerRepetitions = 12;
constexpr double kQuiet_s = 1.0, kQuietPerAgv_s = 0.05, kLongestQuiet_s = 30.0;
// In a divided fleet, an AGV that asks again gets its answer again, at most so often. If the fleet is not large, a
// STATE goes to all so often: ways are better if an AGV knows the ways of those far away.
constexpr std::int64_t kAnswersAgain_ns = kSecond_ns / 3;
constexpr double kTellsAll_s = 3.0, kTellsAllPerAgv_s = 0.2;

}  // namespace

LockProtocol::LockProtocol(const MapView& map, HullGeometry& geometry, Neighbours& neighbours, Controller& controller,
                           LockOptions options, std::uint32_t boot)
    : map_(map),
      geometry_(geometry),
      neighbours_(neighbours),
      controller_(controller),
      options_(options),
      blocker_(neighbours),
      messages_(map, controller, boot, neighbours, claim_, blocker_, options.progress.asks_again) {
  claim_.epoch = first_epoch(boot);
  claim_.grants_name_epoch = options.grants.grants_name_epoch;
  if (neighbours.audience().is_divided()) zones_.emplace(map, geometry, neighbours, controller, claim_, messages_);
}

void LockProtocol::stand(const Path& standing) {
  claim_.held = standing;
  ++held_version_;
  claim_.way.replace(end_of(map_, claim_.held), messages_.begin_new_stamp());
  if (zones_) zones_->announce();
}

bool LockProtocol::request(const Path& section, std::int64_t demand_ns, std::span<const std::uint32_t> onward) {
  if (!continues_held(section)) {
    withdraw();
    return false;
  }
  claim_.request = section;
  claim_.request.heading = end_of(map_, claim_.held).heading;
  ++request_version_;
  claim_.demand_ns = demand_ns;
  claim_.requesting = !zones_ || zones_->find_zones_of_request();
  if (!claim_.requesting) {
    withdraw();
    return false;
  }
  announce(onward);
  open_epoch();
  return true;
}

// As far as the messages have room.
void LockProtocol::announce(std::span<const std::uint32_t> onward) {
  Path way = claim_.request;
  for (const std::uint32_t lane : onward) {
    if (claim_.held.count + way.count < kPathLanesMax) way.append(lane);
  }
  claim_.way.replace(way, messages_.begin_new_stamp());
  if (zones_) zones_->announce();
}

bool LockProtocol::continues_held(const Path& section) const {
  const double claim_m = length_m(map_, claim_.held) + length_m(map_, section);
  return section.station == end_of(map_, claim_.held).station && is_driveable(map_, section) &&
         section.count <= kPathLanesMax - claim_.held.count &&
         claim_m <= neighbours_.claim_limit_m() + kClaimRounding_m;
}

void LockProtocol::open_epoch() {
  claim_.epoch = next_request(claim_.epoch);
  if (!options_.consent.epochs_grow && number_of(claim_.epoch) >= 256 * kAttempts) {
    controller_.sometimes("number-wrapped");
    claim_.epoch = first_epoch(boot_of(claim_.epoch));
  }
  asked_ = false;
  look_at_all_ = true;
  repeated_grants_ = 0;
  answers_may_change_ = true;
  blocker_.ask(controller_.now_ns());
}

void LockProtocol::withdraw() {
  claim_.requesting = false;
  answers_may_change_ = true;
  blocker_.end();
  controller_.waiting_for(FP_NONE);
}

void LockProtocol::know_own_place(bool known) {
  claim_.knows_place = known;
  if (zones_) zones_->announce();
  answers_may_change_ = true;
}

void LockProtocol::lane_passed() {
  if (claim_.held.empty()) return;
  pass_first_lane(map_, claim_.held);
  ++held_version_;
  if (zones_) zones_->announce();
  answers_may_change_ = true;
}

bool LockProtocol::receive(std::uint32_t sender, std::span<const std::byte> bytes) {
  if (sender >= neighbours_.fleet_count()) return false;
  const std::optional<Message> message = decode(bytes, std::as_const(neighbours_).of(sender).way_bytes);
  if (!message) return false;
  // The message is valid as a whole. Only now may it change what this AGV knows of the sender.
  const Neighbours::News news = neighbours_.note(sender, *message, controller_.now_ns());
  if (news == Neighbours::News::Refused) return false;
  if (news == Neighbours::News::Changed) {
    changed_.push_back(sender);
    if (claim_.requesting && blocker_.look_at(sender, claim_.request)) answers_may_change_ = true;
  }
  if (message->has_request()) receive_request(sender, *message);
  const std::uint32_t boot = boot_of(message->status.epoch);
  switch (message->kind) {
    case MessageKind::State:
      controller_.believe(sender, message->status.position_m, std::int64_t{message->status.stamp_ms} * 1'000'000);
      for (const Answers::Answer& answer : message->answers.all()) {
        if (answer.agv == neighbours_.self()) receive_answer(sender, boot, answer.echo, answer.granted);
      }
      break;
    case MessageKind::Request:
      break;
    case MessageKind::Grant:
    case MessageKind::Defer:
      receive_answer(sender, boot, message->echo, message->kind == MessageKind::Grant);
      break;
    case MessageKind::Join:
    case MessageKind::Roll:
      break;
  }
  // All that the message says is known. It may be the consent that was missing.
  if (zones_) zones_->hear(sender, *message);
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
  if (claim_.has_granted(n)) {  // the grant was lost or is still under way; the next STATE repeats it
    controller_.sometimes("grant-lost");
    return answer_if_asked_again(sender);
  }
  const Answer answer = answer_to(sender, n);
  if (answer != Answer::Defer) return grant(sender, n, answer);
  if (n.deferred_epoch == n.request_epoch) return answer_if_asked_again(sender);
  controller_.sometimes("deferred");
  n.deferred_epoch = n.request_epoch;
  n.answer_repeats = {};
  messages_.send_answer(MessageKind::Defer, sender);
}

void LockProtocol::answer_if_asked_again(std::uint32_t sender) {
  const Neighbour& n = neighbours_.of(sender);
  if (zones_ && controller_.now_ns() - n.told_at_ns >= kAnswersAgain_ns) repeat_answer(sender);
}

LockProtocol::Answer LockProtocol::answer_to(std::uint32_t agv, Neighbour& neighbour) {
  if (!claim_.knows_place) return options_.grants.unknown_place_defers ? Answer::Defer : Answer::Grant;
  if (!lock_is_over() && neighbours_.clashes(agv, neighbour.with_held, own_held())) return Answer::Defer;
  if (!claim_.requesting || !neighbours_.clashes(agv, neighbour.with_request, {claim_.request, request_version_}))
    return Answer::Grant;
  return comes_first(agv, neighbour) ? Answer::Defer : Answer::GrantAndStepBack;
}

bool LockProtocol::lock_is_over() {
  if (!options_.grants.bodies_count && claim_.held.empty()) return true;
  return options_.grants.locks_end_after_ns > 0 &&
         controller_.now_ns() - locked_at_ns_ > options_.grants.locks_end_after_ns;
}

bool LockProtocol::comes_first(std::uint32_t agv, const Neighbour& neighbour) {
  if (!options_.progress.order_is_common) return false;
  // A blocked request cannot be locked before another AGV moves. It must not stop that AGV, or the AGVs for which that
  // AGV waits. One that is held up lets others pass meanwhile. Both sides must find the same order; otherwise two
  // requests would step back from each other for ever. Therefore every message contains `blocked` and `held_up`.
  const bool blocked = claim_.requesting && blocker_.is_blocked(claim_.request);
  const bool held_up = claim_.requesting && blocker_.is_held_up(claim_.request);
  const Status& other = neighbour.status;
  const std::uint32_t self = options_.progress.smaller_number_first ? neighbours_.self() : agv;
  return std::tie(blocked, held_up, claim_.demand_ns, self) <
         std::tie(other.blocked, other.held_up, neighbour.demand_ns, agv);
}

void LockProtocol::grant(std::uint32_t agv, Neighbour& neighbour, Answer answer) {
  neighbour.granted_epoch = neighbour.request_epoch;
  neighbour.answer_repeats = {};
  if (answer == Answer::GrantAndStepBack) {
    controller_.sometimes("overtaken");
    give_way_to(neighbour);
  }
  messages_.send_answer(MessageKind::Grant, agv);
}

// The other AGV is asked again when it is time to repeat. If each asked at once over a radio without delay, AGVs that
// want the same floor would let each other pass without end at one instant.
void LockProtocol::give_way_to(Neighbour& neighbour) {
  const bool granted = claim_.has_consent(neighbour);
  if (options_.grants.overtaken == Overtaken::DropsThatGrant) neighbour.granted_us_epoch = 0;
  const bool steps_back = options_.grants.overtaken == Overtaken::StepsBack ||
                          (options_.grants.overtaken == Overtaken::StepsBackIfGranted && granted);
  if (!steps_back) return;
  if (!claim_.is_asked(neighbour))
    neighbour.asked_epoch = claim_.epoch;  // it may have granted that one without being asked
  if (request_of(neighbour.asked_epoch + 1) != claim_.epoch) return open_epoch();
  ++neighbour.asked_epoch;
  neighbour.request_repeats = {};
  neighbour.silent_since_ns = controller_.now_ns();
  look_at_all_ = true;
}

void LockProtocol::answer_those_deferred() {
  std::ranges::sort(changed_);
  if (std::exchange(answers_may_change_, false)) {  // an answer may change it again
    // In a divided fleet, the AGV may just have left the zones of those that it deferred.
    neighbours_.for_each_known([&](std::uint32_t agv, const Neighbour&) { answer_if_asked(agv); });
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

void LockProtocol::receive_answer(std::uint32_t sender, std::uint32_t boot, Epoch echo, bool granted) {
  Neighbour& n = neighbours_.of(sender);
  if (zones_ && boot < boot_of(n.status.epoch)) return;
  if (!claim_.is_asked(n) || (options_.consent.answers_name_epoch && echo != n.asked_epoch)) {
    if (granted && claim_.requesting) controller_.sometimes("late-grant");
    return;
  }
  if (granted) {
    if (claim_.has_consent(n)) ++repeated_grants_;
    n.granted_us_epoch = n.asked_epoch;
  } else {
    n.silent_since_ns = controller_.now_ns();
    n.deferred_us_epoch = n.asked_epoch;
    controller_.waiting_for(sender);
  }
}

bool LockProtocol::settle() {
  answer_those_deferred();
  if (zones_ && zones_->has_news()) zones_->talk(false);
  if (!claim_.requesting || !claim_.knows_place || !all_consent()) return false;
  if (zones_ && !zones_->is_member_there()) {
    look_at_all_ = true;  // consent may change until it is
    return false;
  }
  for (const std::uint32_t lane : claim_.request.lanes()) claim_.held.append(lane);
  ++held_version_;
  claim_.way.shorten(map_, claim_.request.count);
  if (options_.grants.locks_end_after_ns > 0) locked_at_ns_ = controller_.now_ns();
  withdraw();
  return true;
}

// An AGV whose consent was missing can only give it by a message, and `note_consent` sees that. A consent may also be
// lost again. That matters only when none is missing; `repeat` orders a look for it.
bool LockProtocol::all_consent() {
  if (!look_at_all_ && options_.consent.senders_count && options_.consent.silence_consents_after_ns == 0) return false;
  look_at_all_ = false;
  // Every AGV is judged anew. One that must consent for the first time is asked now, so its consent is missing.
  const std::int64_t now_ns = controller_.now_ns();
  const bool first = !asked_;
  missing_ = 0;
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    n.is_missing = !consents(agv, n, now_ns);
    if (!n.is_missing) return;
    ++missing_;
    if (claim_.is_asked(n)) return;
    if (!first) controller_.sometimes("newcomer");
    n.asked_epoch = claim_.epoch;
    n.silent_since_ns = now_ns;
    n.request_repeats = {};
    to_ask_.push_back(agv);
  });
  // `to_ask_` holds the AGVs that have not been asked in this epoch. One message may go to all of them.
  if (first && missing_ == 0) controller_.sometimes("unasked");
  if (first && !to_ask_.empty()) controller_.sometimes("negotiation");
  asked_ = true;
  messages_.ask(to_ask_);
  to_ask_.clear();
  return missing_ == 0 || (!options_.consent.senders_count && missing_ <= repeated_grants_);
}

void LockProtocol::note_consent(std::uint32_t agv) {
  Neighbour& n = neighbours_.of(agv);
  if (!claim_.is_asked(n) || !n.is_missing || !consents(agv, n, controller_.now_ns())) return;
  n.is_missing = false;
  if (missing_ > 0) look_at_all_ = --missing_ == 0;
}

bool LockProtocol::consents(std::uint32_t agv, const Neighbour& neighbour, std::int64_t now_ns) {
  if (claim_.has_consent(neighbour)) return true;
  if (options_.consent.silence_consents_after_ns > 0 && claim_.is_asked(neighbour) &&
      now_ns - neighbour.silent_since_ns >= options_.consent.silence_consents_after_ns) {
    controller_.sometimes("silence-taken-for-consent");
    return true;
  }
  if (zones_ && zones_->is_elsewhere(neighbour)) return true;
  return knows_request(neighbour) && (neighbours_.is_apart(agv, claim_.request, claim_.epoch) ||
                                      neighbours_.surely_beyond(agv, claim_.request, now_ns));
}

// Few repetitions go to their addressees, many go out with the STATE.
void LockProtocol::repeat() {
  look_at_all_ = true;
  if (claim_.requesting && blocker_.grow_old(controller_.now_ns())) answers_may_change_ = true;
  if (zones_) return repeat_in_zones();
  due_.clear();
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    const bool request = options_.progress.asks_again && claim_.is_unanswered(n) && n.request_repeats.is_due();
    const bool answer = claim_.owes_answer(n) && (claim_.has_granted(n) || !n.knows_defer) && n.answer_repeats.is_due();
    if (request || answer) due_.push_back({agv, request, answer});
  });
  if (std::any_of(due_.begin(), due_.end(), [](const Due& due) { return due.request; }))
    controller_.sometimes("retransmission");
  const double longest_quiet_s = std::clamp(kQuietPerAgv_s * neighbours_.fleet_count(), kQuiet_s, kLongestQuiet_s);
  const bool many = due_.size() > 1 && due_.size() * kFewerRepetitions > neighbours_.fleet_count();
  if (many || messages_.quiet_s() > longest_quiet_s) return messages_.broadcast_state();
  for (const Due& due : due_) {
    if (due.request) messages_.send_request(due.agv);
    if (due.answer) repeat_answer(due.agv);
  }
}

void LockProtocol::repeat_answer(std::uint32_t agv) {
  messages_.send_answer(claim_.has_granted(neighbours_.of(agv)) ? MessageKind::Grant : MessageKind::Defer, agv);
}

// A GRANT is repeated without being asked for again: a question and its answer would both have to arrive. In a large
// fleet that costs too much: there, only a GRANT that follows a DEFER is repeated. One message says what is due to an
// AGV.
void LockProtocol::repeat_in_zones() {
  zones_->talk(true);
  const std::int64_t now_ns = controller_.now_ns();
  const bool hears_of_all = neighbours_.audience().hears_of_all();
  const double quiet_s = std::max(kTellsAll_s, kTellsAllPerAgv_s * neighbours_.fleet_count());
  if (hears_of_all && messages_.quiet_s() >= quiet_s) messages_.broadcast_state();
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    const bool request = options_.progress.asks_again && claim_.is_unanswered(n) && n.request_repeats.is_due();
    const bool unasked = claim_.has_granted(n) && (hears_of_all || n.deferred_epoch == n.request_epoch);
    const bool answer = claim_.owes_answer(n) && unasked && n.answer_repeats.is_due();
    if (request) controller_.sometimes("retransmission");
    if ((request && answer) || messages_.is_to_be_told(n, now_ns)) {
      messages_.tell(agv, false);
    } else if (request) {
      messages_.send_request(agv);
    } else if (answer) {
      messages_.send_answer(MessageKind::Grant, agv);
    }
  });
}

}  // namespace fleetproof::agents
