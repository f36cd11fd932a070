// Why two AGVs i and j never hold conflicting hulls.
//
// Terms. An epoch of i is the time during which it requests one fixed path; it ends when the request is locked,
// withdrawn or stepped back from, or when i's computer restarts, and its number, which the boot is part of, is never
// used again. i decides to grant an epoch f of j only if (1) nothing it holds conflicts with j's request and (2) it is
// not inside an epoch of its own whose request conflicts, or ends that epoch at once. Every GRANT for f says that i has
// so decided, at some instant during f: repeated GRANTs speak of the first such decision that i remembers. i locks an
// epoch e only if every AGV has granted e or is excluded: proved at that instant to be so far away that nothing it then
// holds or requests can conflict (Neighbours::surely_beyond; true of every epoch, as a claim never exceeds
// longest_claim_m).
//
// Suppose there is a first instant at which two AGVs hold conflicting hulls: i has locked e at t_i and still holds it
// when j locks f at t_j >= t_i.
// - If j excluded i at t_j, nothing i held at t_j conflicts: contradiction. So i decided to grant f, at some s_i during
// f, s_i <= t_j.
// - i holds what conflicts from t_i to t_j, so by (1) s_i < t_i. By (2) s_i is not inside e, or e would have ended
// there. So s_i lies before e
//   began, hence f began before e did and lasts until t_j: at every instant of e, j is inside f, requesting what
//   conflicts.
// - If i excluded j at t_i, nothing j requested at t_i conflicts: contradiction. So j decided to grant e, at an instant
// s_j inside e, thus inside f.
//   By (2) j ended f at s_j <= t_i <= t_j and could not lock it at t_j (if all three are one instant, j's activations
//   still have an order): contradiction.
// Nothing here speaks of delay, order or number of messages, of clocks, of keys, or of which of several GRANTs was
// used. Keys, retransmission and letting others pass serve progress only. The first hulls are the bodies at the start,
// which the warehouse keeps apart. A hull shrinks only by lanes whose far end the AGV has reached: what it still covers
// is part of the next lane, of a turn, or the standing body. Time passes nothing: an AGV that is stopped, broken down
// or empty in the middle of a lane holds that lane.
//
// Repeating a GRANT without stepping back is sound because the instant that counts is the first: every later epoch of i
// asks j, who is inside f until it has ended f. Without remembering, each duplicate of a REQUEST would make i step back
// once more, and at 40 % loss nobody would get on.
//
// Restarts. What i remembers of others is lost, and with it the requests it has granted. No step above needs that
// memory:
// - i's restart ends its epoch and shrinks what it holds to what the AGV covers until its action is over, the lane
// under way or the standing body. Of
//   what it locked before, that part is held throughout, by the former self and by the new one from its first instant
//   (it answers nobody before). So (1) is true of s_i in [t_i, t_j] whether or not i restarts in between. It may hold
//   the turn before the lane too, without having locked it; that only makes it defer more.
// - A GRANT of the former self for f that is still in the air, or that j holds, stays true: s_i lies before every epoch
// of the new self. When the new
//   self requests e, j is still inside f, or f is over. If inside, j must be asked, by an epoch of the new boot; to
//   grant it ends f, and with f every GRANT for f, whichever boot gave it. There is nothing to wait for.
// - j's restart between s_i and t_j ends f, so j does not lock it. A late GRANT for an epoch of a former boot names
// that boot, and is no answer.
// - The new self decides anew about an f that the former granted: a second decision under the same rules, and any one
// during f will do.
// - What must be known is one's own place: from a position that may be late, a new self learns its heading only when
// that time is over. Until then it
//   grants nothing (know_own_place).
#include "core/agents/lock_protocol.hpp"

#include <algorithm>
#include <tuple>

namespace fleetproof::agents {
namespace {

constexpr std::int64_t kAskAgain_ns = 700'000'000;
constexpr std::int64_t kAskAgainLatest_ns = 4 * kSecond_ns;
constexpr std::int64_t kAskDeferredAgain_ns = 1'500'000'000;
constexpr std::uint32_t kQuickAsks = 10;
constexpr std::uint32_t kJitterDraws = 1;

}  // namespace

void LockProtocol::request(const Path& stretch, std::int64_t demand_ns) {
  request_ = stretch;
  demand_ns_ = demand_ns;
  requesting_ = true;
  open_epoch();
}

void LockProtocol::open_epoch() {
  ++epoch_;
  asked_ = false;
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
  if (n.granted_epoch == n.request_epoch) {  // he asks again: the grant got lost, or is still on its way
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
  if (!own_place_known_ || geometry_.conflict(self, held_, agv, neighbour.request)) return Answer::Defer;
  if (!requesting_ || !geometry_.conflict(self, request_, agv, neighbour.request)) return Answer::Grant;
  // A request that cannot be locked before somebody moves must not keep him, or those he waits for, from moving. Both
  // sides must come to the same order, or two requests would step back from each other for ever: therefore `blocked` is
  // part of what every message tells.
  const bool mine_blocked = is_blocked();
  const bool mine_first =
      std::tie(mine_blocked, demand_ns_, self) < std::tie(neighbour.status.blocked, neighbour.demand_ns, agv);
  return mine_first ? Answer::Defer : Answer::GrantAndStepBack;
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

void LockProtocol::grant(std::uint32_t agv, Neighbour& neighbour, Answer answer) {
  neighbour.granted_epoch = neighbour.request_epoch;
  if (answer == Answer::GrantAndStepBack) {
    controller_.sometimes("overtaken");
    open_epoch();
  }
  send(MessageKind::Grant, agv, neighbour.request_epoch);
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
  if (!requesting_ || message.echo != epoch_) {
    if (message.kind == MessageKind::Grant && requesting_) controller_.sometimes("late-grant");
    return;
  }
  Neighbour& n = neighbours_.of(sender);
  if (message.kind == MessageKind::Grant) {
    n.granted_us_epoch = epoch_;
  } else {
    // He knows of the request and grants it on his own when he can: to ask again is only for the case that this grant
    // gets lost.
    n.silent_since_ns = controller_.now_ns();
    if (n.deferred_us_epoch != epoch_) n.ask_at_ns += kAskDeferredAgain_ns - kAskAgain_ns;
    n.deferred_us_epoch = epoch_;
    controller_.waiting_for(sender);
  }
}

bool LockProtocol::settle() {
  answer_those_deferred();
  if (!requesting_ || !own_place_known_ || !all_consent()) return false;
  for (const std::uint32_t lane : request_.lanes()) held_.append(lane);
  withdraw();
  return true;
}

bool LockProtocol::all_consent() {
  const std::int64_t now_ns = controller_.now_ns();
  const bool first = !asked_;
  bool all = true, asked_anybody = false;
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    if (consents(agv, n, now_ns)) return;
    all = false;
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
  return all;
}

bool LockProtocol::consents(std::uint32_t agv, const Neighbour& neighbour, std::int64_t now_ns) {
  if (neighbour.granted_us_epoch == epoch_) return true;
  if (options_.silence_consents_after_ns > 0 && neighbour.asked_epoch == epoch_ &&
      now_ns - neighbour.silent_since_ns >= options_.silence_consents_after_ns) {
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
  std::int64_t next_ns = -1;
  neighbours_.for_each([&](std::uint32_t agv, Neighbour& n) {
    if (n.asked_epoch != epoch_ || n.granted_us_epoch == epoch_) return;
    if (n.ask_at_ns <= now_ns && consents(agv, n, now_ns)) n.ask_at_ns = now_ns + kAskAgainLatest_ns;
    if (n.ask_at_ns <= now_ns) {
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
  controller_.broadcast(WireMessage(message).bytes());
}

void LockProtocol::send(MessageKind kind, std::uint32_t receiver, Epoch echo) {
  Message message;
  message.kind = kind;
  fill_in(message.status);
  message.demand_ns = demand_ns_;
  if (kind == MessageKind::Request) message.request = request_;
  message.echo = echo;
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
