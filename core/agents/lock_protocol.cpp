// Proof that two AGVs i and j never hold conflicting hulls.
//
// Terms
// - An epoch of i towards j is the time in which i asks j for its consent to one fixed path. It ends when i locks the
//   path, withdraws the request or steps back from j, or when the computer of i restarts. Its number consists of the
//   boot, the request and the attempt, and is never used again.
// - i decides to grant an epoch f of j (towards i) only under two conditions. (1) Nothing that i holds conflicts with
//   the request of j. (2) i is not inside an epoch towards j whose request conflicts, or i ends that epoch at once.
// - A GRANT for f says that i decided so at some instant during f. Repeated GRANTs refer to the first decision that i
//   remembers.
// - i locks a path only if every other AGV j has granted the epoch e of i towards j, or is excluded. An AGV is excluded
//   if i has proved at that instant that it is far away: nothing that it then holds or requests can conflict
//   (Neighbours::surely_beyond). This covers every request, because a claim is never longer than longest_claim_m.
//
// Proof by contradiction. Suppose there is a first instant at which two AGVs hold conflicting hulls: i locked at t_i
// and still holds it when j locks at t_j >= t_i. Let f be the epoch of j towards i that ends at t_j.
// - If j excluded i at t_j, nothing that i held at t_j conflicts: contradiction. So i decided to grant f, at an instant
//   s_i during f, and s_i <= t_j.
// - i holds the conflicting hull from t_i to t_j, so s_i < t_i by (1), and f lasts from s_i or before until t_j. At
//   t_i, j thus requests what conflicts. So i did not exclude j at t_i, and j decided to grant the epoch e of i towards
//   j that ends at t_i, at an instant s_j inside e.
// - By (2), s_i is not inside e, because e would have ended there. So s_i lies before the beginning of e, and e lies
//   inside f. With it, s_j is inside f. By (2), j ended f at s_j <= t_i <= t_j. So j could not lock at t_j with f:
//   contradiction. (If all three are one instant, the activations of j still have an order.)
//
// The proof uses no assumption about the delay, the order or the number of messages, about clocks or keys, or about
// which of several GRANTs was used and which message carried it. Keys, repetition and making way serve progress only.
// Time releases nothing. The first hulls are the bodies at the start, and the warehouse keeps those apart. It does so
// without their loads; an AGV takes a load there only when it has locked its way from there, and with it the floor
// under the load (HullLock::must_lock_first).
//
// What i holds contains its body. The proof above is about held paths; these rules tie the body to the held path:
// - At the start and at a restart, i holds the standing body or the lanes to be driven (see Restarts).
// - The held path is always one way that can be driven: it grows only by a stretch that begins where it ends
//   (continues_held), and loses only its first lane.
// - i moves only over the first held lane (may_drive), and gives no action while another one may be under way, but for
//   one: while i drives the first held lane, it may give the move over the second one (may_drive_next). That move
//   begins when the first one ends, so i drives the held lanes in their order, with a stop between them or without. A
//   call that is refused moves nothing. So whatever stops, delays or frees the AGV, its body covers the first held
//   lane, the turn before it, or the place where it stands. Which leg the agent had in mind, and why, plays no part.
// - That lane is released when its move ends with FP_OK, so the AGV stands at its end or passes it. What the AGV still
//   covers then belongs to the next lane, to a turn, or to the standing body. An AGV passes a station only if the next
//   lane goes straight on: then the body at the end of one lane is the body at the beginning of the next one. A move
//   that ends otherwise, or does not end, releases nothing: an AGV that is stopped, broken down or empty in the middle
//   of a lane holds that lane.
//
// Why does i step back from j alone? The proof speaks of two AGVs and their epochs towards each other. What a third one
// granted to i stays true.
//
// Why may a GRANT be repeated without stepping back, asked for again or not? Because the first decision counts: every
// later epoch of i asks j, and j is inside f until it has ended f. If i did not remember its grants, each repeated
// REQUEST would make i step back again. At 40 % loss no AGV would then make progress.
//
// Restarts. A restarted i has forgotten its knowledge of other AGVs, and the requests that it granted. No step above
// needs this memory:
// - The restart of i ends its epoch. i then holds only what the AGV covers until its actions end: the lane under way
// and
//   the lane of a move that has been given already, or the standing body. This part of the locked floor is held without
//   a gap, by the former self and by the new self from its first instant, because the new self answers no message
//   before. So (1) is true of every s_i in [t_i, t_j], with or without a restart between them. The new self may also
//   hold the turn before the lane without having locked it. That only makes it defer more often.
// - A GRANT of the former self for f may still be in the air, or j may have it. It stays true, because s_i lies before
//   every epoch of the new self. When the new self requests e, there are two cases. If f is over, the GRANT has no
//   effect. If j is still inside f, the new self must ask j, in an epoch of the new boot. To grant it, j ends f, and
//   with f every GRANT for f from any boot. So there is nothing to wait for.
// - A restart of j between s_i and t_j ends f, so j does not lock f. A late GRANT for an epoch of a former boot names
//   that boot, and is not an answer.
// - The new self decides again about an f that the former self granted. That is a second decision under the same rules,
//   and any decision during f is sufficient.
// - The new self must know its own place. If positions may be late, it knows the heading of its AGV only after that
//   time. Until then it grants nothing (know_own_place).
#include "core/agents/lock_protocol.hpp"

#include <algorithm>
#include <tuple>

namespace fleetproof::agents {
namespace {

constexpr double kRounding_m = 1e-6;  // of sums of lengths; the proof of distance has a margin of a metre

}  // namespace

bool LockProtocol::request(const Path& stretch, std::int64_t demand_ns) {
  if (!continues_held(stretch)) {
    withdraw();
    return false;
  }
  request_ = stretch;
  request_.heading = end_of(map_, held_).heading;
  demand_ns_ = demand_ns;
  requesting_ = true;
  open_epoch();
  return true;
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
  blocked_is_known_ = false;
}

void LockProtocol::withdraw() {
  requesting_ = false;
  answers_may_change_ = true;
  blocked_is_known_ = false;
  controller_.waiting_for(FP_NONE);
}

void LockProtocol::know_own_place(bool known) {
  own_place_known_ = known;
  answers_may_change_ = true;
}

void LockProtocol::lane_passed() {
  if (held_.empty()) return;
  pass_first_lane(map_, held_);
  answers_may_change_ = true;
}

void LockProtocol::describe(bool waiting, bool idle, bool out_of_order) {
  waiting_ = waiting;
  idle_ = idle;
  out_of_order_ = out_of_order;
}

bool LockProtocol::receive(std::uint32_t sender, std::span<const std::byte> bytes) {
  const std::optional<Message> message = decode(bytes);
  if (!message) return false;
  const Neighbours::News news = neighbours_.note(sender, *message, controller_.now_ns());
  if (news == Neighbours::News::Refused) return false;
  if (news == Neighbours::News::Changed) {
    answers_may_change_ = true;
    blocked_is_known_ = false;
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

LockProtocol::Answer LockProtocol::answer_to(std::uint32_t agv, const Neighbour& neighbour) {
  const std::uint32_t self = neighbours_.self();
  if (!own_place_known_) return options_.grants.unknown_place_defers ? Answer::Defer : Answer::Grant;
  if (!lock_is_over() && geometry_.conflict(self, held_, agv, neighbour.request)) return Answer::Defer;
  if (!requesting_ || !geometry_.conflict(self, request_, agv, neighbour.request)) return Answer::Grant;
  return comes_first(agv, neighbour) ? Answer::Defer : Answer::GrantAndStepBack;
}

bool LockProtocol::lock_is_over() {
  if (!options_.grants.bodies_count && held_.empty()) return true;
  return options_.grants.locks_end_after_ns > 0 &&
         controller_.now_ns() - locked_at_ns_ > options_.grants.locks_end_after_ns;
}

bool LockProtocol::comes_first(std::uint32_t agv, const Neighbour& neighbour) {
  // A blocked request cannot be locked before another AGV moves. It must not stop that AGV, or the AGVs for which that
  // AGV waits. Both sides must find the same order; otherwise two requests would step back from each other for ever.
  // Therefore every message contains `blocked`.
  const bool mine_blocked = is_blocked();
  const bool other_blocked = neighbour.status.blocked && options_.progress.order_is_common;
  const std::uint32_t self = options_.progress.smaller_number_first ? neighbours_.self() : agv;
  return std::tie(mine_blocked, demand_ns_, self) < std::tie(other_blocked, neighbour.demand_ns, agv);
}

bool LockProtocol::is_blocked() {
  if (!blocked_is_known_) blocked_ = requesting_ && waiting_inside(request_) != FP_NONE;
  blocked_is_known_ = true;
  return blocked_;
}

std::uint32_t LockProtocol::waiting_inside(const Path& path) {
  std::uint32_t found = FP_NONE;
  neighbours_.for_each([&](std::uint32_t agv, const Neighbour& n) {
    const bool stands = n.known && (n.status.waiting || n.status.out_of_order);
    if (found == FP_NONE && stands && geometry_.conflict(neighbours_.self(), path, agv, n.status.held)) found = agv;
  });
  return found;
}

bool LockProtocol::is_held(const Path& path) {
  bool held = false;
  neighbours_.for_each([&](std::uint32_t agv, const Neighbour& n) {
    held = held || (n.known && geometry_.conflict(neighbours_.self(), path, agv, n.status.held));
  });
  return held;
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
  if (!steps_back || !is_asked(neighbour)) return;
  if (request_of(neighbour.asked_epoch + 1) != epoch_) return open_epoch();
  ++neighbour.asked_epoch;
  neighbour.request_repeats = {};
  neighbour.silent_since_ns = controller_.now_ns();
  look_at_all_ = true;
}

bool LockProtocol::is_asked(const Neighbour& n) const { return requesting_ && request_of(n.asked_epoch) == epoch_; }
bool LockProtocol::has_consent(const Neighbour& n) const { return is_asked(n) && n.granted_us_epoch == n.asked_epoch; }

void LockProtocol::answer_those_deferred() {
  if (!answers_may_change_) return;
  answers_may_change_ = false;
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    if (!n.request_is_open() || n.granted_epoch == n.request_epoch) return;
    const Answer answer = answer_to(agv, n);
    if (answer != Answer::Defer) grant(agv, n, answer);
  });
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
  return neighbours_.surely_beyond(agv, request_, now_ns);
}

// Whether this epoch has asked it and got no answer.
bool LockProtocol::is_unanswered(const Neighbour& n) const {
  return is_asked(n) && !has_consent(n) && n.deferred_us_epoch != n.asked_epoch;
}

bool LockProtocol::owes_answer(const Neighbour& n) const {
  return n.request_is_open() && n.asks_us && (has_granted(n) || n.deferred_epoch == n.request_epoch);
}

}  // namespace fleetproof::agents
