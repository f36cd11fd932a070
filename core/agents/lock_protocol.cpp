// Proof that two AGVs i and j never hold conflicting hulls.
//
// Terms
// - An epoch of i is the time in which i requests one fixed path. It ends when i locks the request, withdraws it or
//   steps back, or when the computer of i restarts. Its number contains the boot and is never used again.
// - i decides to grant an epoch f of j only under two conditions. (1) Nothing that i holds conflicts with the request
// of
//   j. (2) i is not inside an epoch of its own whose request conflicts, or i ends that epoch at once.
// - A GRANT for f says that i decided so at some instant during f. Repeated GRANTs refer to the first decision that i
//   remembers.
// - i locks an epoch e only if every other AGV has granted e or is excluded. An AGV is excluded if i has proved at that
//   instant that it is far away: nothing that it then holds or requests can conflict (Neighbours::surely_beyond). The
//   proof covers every epoch, because a claim is never longer than longest_claim_m.
//
// Proof by contradiction. Suppose there is a first instant at which two AGVs hold conflicting hulls. i locked e at t_i
// and still holds it when j locks f at t_j >= t_i.
// - If j excluded i at t_j, nothing that i held at t_j conflicts: contradiction. So i decided to grant f, at an instant
//   s_i during f, and s_i <= t_j.
// - i holds the conflicting hull from t_i to t_j, so s_i < t_i by (1). By (2), s_i is not inside e, because e would
// have
//   ended there. So s_i lies before the beginning of e. Hence f began before e began, and f lasts until t_j. At every
//   instant of e, j is inside f and requests what conflicts.
// - If i excluded j at t_i, nothing that j requested at t_i conflicts: contradiction. So j decided to grant e, at an
//   instant s_j inside e, and thus inside f. By (2), j ended f at s_j <= t_i <= t_j. So j could not lock f at t_j:
//   contradiction. (If all three are one instant, the activations of j still have an order.)
//
// The proof uses no assumption about the delay, the order or the number of messages, about clocks or keys, or about
// which of several GRANTs was used. Keys, retransmission, the pause after a step back and making way serve progress
// only. Time releases nothing. The first hulls are the bodies at the start, and the warehouse keeps those apart. It
// does so without their loads; an AGV takes a load there only when it has locked its way from there, and with it the
// floor under the load (HullLock::must_lock_first).
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

constexpr std::int64_t kAskAgain_ns = 700'000'000;
constexpr std::int64_t kAskAgainLatest_ns = 2 * kSecond_ns;
constexpr std::int64_t kAskDeferredAgain_ns = 1'500'000'000;
// After a step back, the new epoch asks nobody for this long. Suppose n AGVs want the same floor over a radio without
// delay. If each asked at once, every new epoch of one would make all later ones step back again: 2^n epochs at one
// instant. With the pause, an AGV asks once in each pause.
constexpr std::int64_t kStepBackPause_ns = 200'000'000;
constexpr std::uint32_t kQuickAsks = 10;
constexpr std::uint32_t kJitterDraws = 1;
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
  ++epoch_;
  if (!options_.consent.epochs_grow && number_of(epoch_) > 0xffU) {
    controller_.sometimes("number-wrapped");
    epoch_ = first_epoch(boot_of(epoch_));
  }
  asked_ = false;
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
  switch (message->kind) {
    case MessageKind::State:
      controller_.believe(sender, message->status.position_m, std::int64_t{message->status.stamp_ms} * 1'000'000);
      break;
    case MessageKind::Request:
      if (message->status.epoch == neighbours_.of(sender).request_epoch && neighbours_.of(sender).request_is_open())
        answer_request(sender);
      break;
    case MessageKind::Grant:
    case MessageKind::Defer:
      receive_answer(sender, *message);
      break;
  }
  return true;
}

void LockProtocol::answer_request(std::uint32_t sender) {
  Neighbour& n = neighbours_.of(sender);
  const bool granted = options_.grants.grants_name_epoch ? n.granted_epoch == n.request_epoch : n.granted_epoch > 0;
  if (granted) {  // a repeated request: the grant was lost or is still under way
    controller_.sometimes("grant-lost");
    return send(MessageKind::Grant, sender, n.request_epoch);
  }
  const Answer answer = answer_to(sender, n);
  if (answer != Answer::Defer) return grant(sender, n, answer);
  controller_.sometimes("deferred");
  send(MessageKind::Defer, sender, n.request_epoch);
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
  if (answer == Answer::GrantAndStepBack) {
    controller_.sometimes("overtaken");
    give_way_to(neighbour);
  }
  send(MessageKind::Grant, agv, neighbour.request_epoch);
}

void LockProtocol::give_way_to(Neighbour& neighbour) {
  const bool granted = neighbour.granted_us_epoch == epoch_;
  if (options_.grants.overtaken == Overtaken::StepsBack ||
      (options_.grants.overtaken == Overtaken::StepsBackIfGranted && granted)) {
    open_epoch();
    ask_from_ns_ = controller_.now_ns() + jittered(kStepBackPause_ns);
    return;
  }
  if (options_.grants.overtaken == Overtaken::DropsThatGrant) neighbour.granted_us_epoch = 0;
}

void LockProtocol::repeat_grants() {
  neighbours_.for_each([&](std::uint32_t agv, const Neighbour& n) {
    if (n.request_is_open() && n.granted_epoch == n.request_epoch) send(MessageKind::Grant, agv, n.request_epoch);
  });
}

void LockProtocol::answer_those_deferred() {
  if (!answers_may_change_) return;
  answers_may_change_ = false;
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    if (!n.request_is_open() || n.granted_epoch == n.request_epoch) return;
    const Answer answer = answer_to(agv, n);
    if (answer != Answer::Defer) grant(agv, n, answer);
  });
}

void LockProtocol::receive_answer(std::uint32_t sender, const Message& message) {
  if (!requesting_ || (options_.consent.answers_name_epoch && message.echo != epoch_)) {
    if (message.kind == MessageKind::Grant && requesting_) controller_.sometimes("late-grant");
    return;
  }
  Neighbour& n = neighbours_.of(sender);
  if (message.kind == MessageKind::Grant) {
    if (n.granted_us_epoch == epoch_) ++repeated_grants_;
    n.granted_us_epoch = epoch_;
  } else {
    // The sender knows the request and will grant it without a question. Asking again is only needed if that grant is
    // lost.
    n.silent_since_ns = controller_.now_ns();
    if (n.deferred_us_epoch != epoch_) n.ask_at_ns += kAskDeferredAgain_ns - kAskAgain_ns;
    n.deferred_us_epoch = epoch_;
    controller_.waiting_for(sender);
  }
}

bool LockProtocol::settle() {
  answer_those_deferred();
  if (!requesting_ || !own_place_known_ || controller_.now_ns() < ask_from_ns_ || !all_consent()) return false;
  for (const std::uint32_t lane : request_.lanes()) held_.append(lane);
  if (options_.grants.locks_end_after_ns > 0) locked_at_ns_ = controller_.now_ns();
  withdraw();
  return true;
}

bool LockProtocol::all_consent() {
  const std::int64_t now_ns = controller_.now_ns();
  const bool first = !asked_;
  std::uint32_t missing = 0;
  bool asked_anybody = false;
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    if (consents(agv, n, now_ns)) return;
    ++missing;
    if (n.asked_epoch == epoch_) return;
    if (first && !asked_anybody) controller_.sometimes("negotiation");
    asked_anybody = true;
    if (!first) controller_.sometimes("newcomer");
    n.asked_epoch = epoch_;
    n.times_asked = 0;
    n.silent_since_ns = now_ns;
    ask(agv, n, now_ns);
  });
  asked_ = true;
  return missing == 0 || (!options_.consent.senders_count && missing <= repeated_grants_);
}

bool LockProtocol::consents(std::uint32_t agv, const Neighbour& neighbour, std::int64_t now_ns) {
  if (neighbour.granted_us_epoch == epoch_) return true;
  if (options_.consent.silence_consents_after_ns > 0 && neighbour.asked_epoch == epoch_ &&
      now_ns - neighbour.silent_since_ns >= options_.consent.silence_consents_after_ns) {
    controller_.sometimes("silence-taken-for-consent");
    return true;
  }
  return neighbours_.surely_beyond(agv, request_, now_ns);
}

void LockProtocol::ask(std::uint32_t agv, Neighbour& neighbour, std::int64_t now_ns) {
  send(MessageKind::Request, agv, 0);
  std::int64_t pause_ns = kAskAgain_ns;
  if (neighbour.deferred_us_epoch == epoch_) {
    pause_ns = kAskDeferredAgain_ns;
  } else {
    for (std::uint32_t i = kQuickAsks; i <= neighbour.times_asked && pause_ns < kAskAgainLatest_ns; ++i) pause_ns *= 2;
  }
  ++neighbour.times_asked;
  neighbour.ask_at_ns = now_ns + jittered(std::min(pause_ns, kAskAgainLatest_ns));
}

std::int64_t LockProtocol::jittered(std::int64_t pause_ns) {
  return static_cast<std::int64_t>(static_cast<double>(pause_ns) * (0.8 + 0.4 * controller_.random(kJitterDraws)));
}

std::int64_t LockProtocol::ask_again() {
  if (!requesting_) return -1;
  const std::int64_t now_ns = controller_.now_ns();
  if (now_ns < ask_from_ns_) return ask_from_ns_;
  std::int64_t next_ns = -1;
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    if (n.asked_epoch != epoch_ || n.granted_us_epoch == epoch_) return;
    if (n.ask_at_ns <= now_ns && consents(agv, n, now_ns)) n.ask_at_ns = now_ns + kAskAgainLatest_ns;
    if (n.ask_at_ns <= now_ns && options_.progress.asks_again) {
      controller_.sometimes("retransmission");
      ask(agv, n, now_ns);
    }
    if (next_ns < 0 || n.ask_at_ns < next_ns) next_ns = n.ask_at_ns;
  });
  return next_ns;
}

void LockProtocol::broadcast_state() {
  Message message;
  fill_in(message.status);
  // Others take the table as proof that the position is newer than what it acknowledges.
  if (position_at_ns_ == controller_.now_ns()) neighbours_.tell_heard_from(message.heard);
  controller_.describe(name_of(message.kind));
  controller_.broadcast(WireMessage(message).bytes());
}

void LockProtocol::send(MessageKind kind, std::uint32_t receiver, Epoch echo) {
  Message message;
  message.kind = kind;
  fill_in(message.status);
  message.demand_ns = demand_ns_;
  if (kind == MessageKind::Request) message.request = request_;
  message.echo = echo;
  controller_.describe(name_of(kind));
  controller_.send(WireMessage(message).bytes(), receiver);
}

void LockProtocol::fill_in(Status& status) {
  const std::int64_t now_ns = controller_.now_ns();
  fp_pose pose{};
  if (position_at_ns_ != now_ns && controller_.pose(pose)) {
    position_m_ = {pose.x_m, pose.y_m};
    position_at_ns_ = now_ns;
  }
  status.stamp_ms = Neighbours::stamp_ms(now_ns);
  status.position_m = position_m_;
  status.epoch = epoch_;
  status.requesting = requesting_;
  status.blocked = is_blocked();
  status.waiting = waiting_;
  status.idle = idle_;
  status.out_of_order = out_of_order_;
  status.held = held_;
}

}  // namespace fleetproof::agents
