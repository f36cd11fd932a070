// Proof that two AGVs i and j never hold conflicting hulls.
//
// Terms
// - An epoch of i towards j is the time in which i requests one fixed path, whether it asks j for its consent or not.
//   It ends when i locks the path, withdraws the request or steps back from j, or when the computer of i restarts.
//   Stepping back begins the next one. Its number consists of the boot, the request and the attempt, and is never used
//   again.
// - i decides to grant an epoch f of j (towards i) only under two conditions. (1) Nothing that i holds conflicts with
//   the request of j. (2) i is not inside an epoch towards j whose request conflicts, or i ends that epoch at once.
// - A GRANT for f says that i decided so at some instant during f. Repeated GRANTs refer to the first decision that i
//   remembers.
// - Every message contains what its sender holds, and the way that it announces from there. The way begins with the
//   request, if there is one.
// - i locks a path only if every other AGV j has granted the epoch e of i towards j, or is excluded. To be excluded, j
//   must have heard of the path: it has acknowledged a stamp of i from which on each message of i contained the path.
//   And at that instant one of two things must be true:
//   (far) i has proved that nothing that j then holds or requests can conflict (Neighbours::surely_beyond). This covers
//   every request, because a claim is never longer than longest_claim_m.
//   (apart) In the newest message of j that i knows, neither the held path nor the announced way conflicts, and j knows
//   its own place. If i has restarted, j sent that message since (Neighbours::is_apart).
//   In a fleet that is divided into zones, there is a third way, for which j need not have heard of the path:
//   (elsewhere) i is a member of all zones of the path, and the newest message of j that i knows announces none of
//   them, or no message is known. membership.hpp says what this is, and proves (Z1) and (Z2).
//
// What the newest message says
// (N) Suppose that from the stamp s on, each message of j contained the lane Q until the instant t, as request, way or
//   held path, and that i heard one of them before t. Then the newest message of j that i knows at t has the stamp s or
//   a later one, so it contains Q, and j is not apart from a path of i that conflicts with Q. If i has restarted since
//   it heard that message, what the new self takes as newest was sent after the restart, and so after s. A new way
//   begins with a stamp that no message had before, so messages of one stamp do not differ in what they announce.
//
// Proof by contradiction. Suppose there is a first instant at which two AGVs hold conflicting hulls: i locked at t_i
// and still holds it when j locks at t_j >= t_i. Let f be the epoch of j towards i that ends at t_j.
// - j did not exclude i at t_j. It was not far, because it held what conflicts. Nor was it apart: before t_i, j had
//   heard of the path that i then locked, because it had granted it or acknowledged it. Since then each message of i
//   contained what i still holds of it at t_j, so (N) is true. In a divided fleet, (Z1) says that i was neither apart
//   nor elsewhere. So i decided to grant f, at an instant s_i during f, and s_i <= t_j.
// - i holds the conflicting hull from t_i to t_j, so s_i < t_i by (1), and f lasts from s_i or before until t_j. At
//   t_i, j thus requests what conflicts, and i had heard of it at s_i, so j was neither far nor, by (N), apart or
//   elsewhere: what contains a path announces its zones. (In a divided fleet, i has not restarted between s_i and t_i:
//   (Z2). In another one, is_apart covers that.) So i did not exclude j at t_i, and j decided to grant the epoch e of i
//   towards j that ends at t_i, at an instant s_j inside e.
// - By (2), s_i is not inside e, because e would have ended there. So s_i lies before the beginning of e, and e lies
//   inside f. With it, s_j is inside f. By (2), j ended f at s_j <= t_i <= t_j. So j could not lock at t_j with f:
//   contradiction. (If all three are one instant, the activations of j still have an order.)
//
// The proof uses no assumption about the delay, the order or the number of messages, about clocks or keys, or about
// which of several GRANTs was used and which message carried it. Keys, repetition and making way serve progress only.
// Time releases nothing. The first hulls are the bodies at the start, which the warehouse keeps apart. That is promised
// for bodies without loads; an AGV takes a load there only when it has locked its way from there, and with it the floor
// under the load (HullLock::must_lock_first).
//
// What i holds contains its body. The proof above is about held paths; these rules tie the body to the held path:
// - At the start and at a restart, i holds the standing body or the lanes to be driven (see Restarts).
// - The held path is always one way that can be driven: it grows only by a section that begins where it ends
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
// - The restart of i ends its epoch. i then holds only what the AGV covers until its actions end: the lane under way,
//   with the lane of a move that has been given already, or the standing body. This part of the floor is held without a
//   gap, by the former self and by the new self from its first instant, because the new self answers no message
//   before. So (1) is true of every s_i in [t_i, t_j], with or without a restart between them. The new self may also
//   hold the disc of the turn before the lane, without having locked more than its sector or none of it. No request of
//   it ever contains that disc, and it goes with the lane: it only makes the new self defer more often. The proof is
//   about what was locked.
// - A GRANT of the former self for f may still be in the air, or j may have it. It stays true, because s_i lies before
//   every epoch of the new self. When the new self requests e, there are two cases. If f is over, the GRANT has no
//   effect. If j is still inside f, the new self must ask j, in an epoch of the new boot. To grant it, j ends f, and
//   with f every GRANT for f from any boot. So there is nothing to wait for.
// - A restart of j between s_i and t_j ends f, so j does not lock f. A late GRANT for an epoch of a former boot names
//   that boot, and is not an answer.
// - The new self decides again about an f that the former self granted. That is a second decision under the same rules,
//   and any decision during f is sufficient.
// - The new self must know its own place. If positions may be late, it knows the heading of its AGV only after that
//   time. If a contact has stopped the AGV, it may be beside its station; then the AGV is out of order, and the new
//   self never knows. Until it knows, it grants nothing, and its messages say that what it holds is not known
//   (know_own_place). Nobody takes it for apart.
// - No AGV is carried. If an operator sets an AGV down, others may still count it as apart or far from what it had said
//   before, and lock the floor under it. The operator must prevent this.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/agents/blocker.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/lock_claim.hpp"
#include "core/agents/lock_messages.hpp"
#include "core/agents/lock_options.hpp"
#include "core/agents/neighbours.hpp"
#include "core/agents/path.hpp"
#include "core/agents/protocol_messages.hpp"
#include "core/agents/zone_talk.hpp"

namespace fleetproof::agents {

// Mutual exclusion of hulls, by messages that may be lost, late, reordered or doubled. If all AGVs of a fleet run this
// protocol, no two of them ever hold conflicting hulls. An AGV always holds the path on which it stands or drives, and
// it may request a longer one. The proof is at the beginning of this file.
class LockProtocol {
 public:
  LockProtocol(const MapView& map, HullGeometry& geometry, Neighbours& neighbours, Controller& controller,
               LockOptions options, std::uint32_t boot = 0);

  // Call once at the start: the place where the AGV stands, and the lane that it is driving, if any. The AGV holds this
  // path.
  void stand(const Path& standing);
  // While the AGV does not know for certain what it covers, it grants nothing. Requires: nothing is requested
  // meanwhile.
  void know_own_place(bool known);
  const Path& held() const { return claim_.held; }
  OwnPath own_held() const { return {claim_.held, held_version_}; }
  bool requesting() const { return claim_.requesting; }
  const Path& requested() const { return claim_.request; }
  Epoch epoch() const { return claim_.epoch; }

  // Requests `section` in addition to the held path. Replaces an open request. `demand_ns`: since when the AGV has
  // wanted to go on. If two AGVs wait for each other, the older demand comes first. `onward`: the lanes that the AGV
  // means to drive afterwards. Announced early, they need no consent of AGVs with other ways.
  // False if `section` does not begin where the held path ends, or is too long. Nothing is requested then.
  bool request(const Path& section, std::int64_t demand_ns, std::span<const std::uint32_t> onward = {});
  void withdraw();
  // True if the held path begins with this lane. The AGV must drive no other lane.
  bool may_drive(std::uint32_t lane) const { return !claim_.held.empty() && claim_.held.lane_ids[0] == lane; }
  // True if this is the second lane of the held path. While the AGV drives the first one, this move may be given.
  bool may_drive_next(std::uint32_t lane) const { return claim_.held.count > 1 && claim_.held.lane_ids[1] == lane; }
  // The AGV has reached the end of the first held lane, and releases that lane. No effect if no lane is held.
  void lane_passed();
  // The state of the AGV that the next messages contain.
  void describe(bool waiting, bool idle, bool out_of_order) { messages_.describe(waiting, idle, out_of_order); }

  // False if the bytes are not a message of this protocol.
  bool receive(std::uint32_t sender, std::span<const std::byte> bytes);
  // Call this at the end of every activation. It answers requests that can be answered now, and asks AGVs that have not
  // been asked. True if the request is locked: the held path then contains it.
  bool settle();
  // Sends again what may have been lost: the open request to those who have not answered, and answers to requests that
  // are open. From time to time, and if that is shorter, it tells all AGVs the own state, and all this with it. Call
  // this about every half second.
  void repeat();

  // An AGV that stands and waits inside the hull of `path`; FP_NONE if none is known.
  std::uint32_t waiting_inside(const Path& path) const { return neighbours_.first_inside(path, Inside::Waiting); }
  // Whether another AGV is known to hold floor inside the hull of `path`.
  bool is_held(const Path& path) const { return neighbours_.first_inside(path, Inside::Holding) != FP_NONE; }

 private:
  // What is to be sent again.
  struct Due {
    std::uint32_t agv;
    bool request, answer;
  };
  enum class Answer : std::uint8_t { Grant, GrantAndStepBack, Defer };

  bool continues_held(const Path& section) const;
  void announce(std::span<const std::uint32_t> onward);
  // Whether it has heard the way that contains the request. Then it counts on nothing that was announced before.
  bool knows_request(const Neighbour& neighbour) const {
    return !options_.consent.ways_are_heard || neighbour.heard_us_ms >= claim_.way.since_ms(claim_.request.count);
  }
  void open_epoch();
  void receive_request(std::uint32_t sender, const Message& message);
  void answer_request(std::uint32_t sender);
  void answer_if_asked_again(std::uint32_t sender);
  void repeat_answer(std::uint32_t agv);
  void repeat_in_zones();
  Answer answer_to(std::uint32_t agv, Neighbour& neighbour);
  bool lock_is_over();
  bool comes_first(std::uint32_t agv, const Neighbour& neighbour);
  void grant(std::uint32_t agv, Neighbour& neighbour, Answer answer);
  void give_way_to(Neighbour& neighbour);
  void answer_those_deferred();
  void answer_if_asked(std::uint32_t agv);
  void receive_answer(std::uint32_t sender, std::uint32_t boot, Epoch echo, bool granted);
  bool consents(std::uint32_t agv, const Neighbour& neighbour, std::int64_t now_ns);
  bool all_consent();
  void note_consent(std::uint32_t agv);

  const MapView& map_;
  HullGeometry& geometry_;
  Neighbours& neighbours_;
  Controller& controller_;
  LockOptions options_;

  Claim claim_;
  std::uint32_t held_version_ = 0, request_version_ = 0;  // how often each has changed
  bool asked_ = false;                 // every AGV that had to be asked when this epoch began has been asked
  bool look_at_all_ = true;            // consent may be complete, or somebody else may have to be asked
  std::uint32_t missing_ = 0;          // AGVs whose consent this epoch lacks
  std::uint32_t repeated_grants_ = 0;  // of this epoch
  std::vector<std::uint32_t> to_ask_;  // AGVs that must consent and have not been asked by this epoch
  std::vector<Due> due_;
  std::int64_t locked_at_ns_ = 0;
  // Since the deferred requests were last examined: something changed that concerns all of them, and who changed.
  bool answers_may_change_ = false;
  std::vector<std::uint32_t> changed_;

  Blocker blocker_;  // of the request
  LockMessages messages_;
  std::optional<ZoneTalk> zones_;  // in a divided fleet
};

}  // namespace fleetproof::agents
