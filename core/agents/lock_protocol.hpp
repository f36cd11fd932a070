#pragma once

#include <cstdint>
#include <vector>

#include "core/agents/controller.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/lock_options.hpp"
#include "core/agents/neighbours.hpp"
#include "core/agents/path.hpp"
#include "core/agents/protocol_messages.hpp"

namespace fleetproof::agents {

// Mutual exclusion of hulls, by messages that may be lost, late, reordered or doubled. If all AGVs of a fleet run this
// protocol, no two of them ever hold conflicting hulls. An AGV always holds the path on which it stands or drives, and
// it may request a longer one. The proof is at the beginning of lock_protocol.cpp.
class LockProtocol {
 public:
  LockProtocol(const MapView& map, HullGeometry& geometry, Neighbours& neighbours, Controller& controller,
               LockOptions options, std::uint32_t boot = 0)
      : map_(map),
        geometry_(geometry),
        neighbours_(neighbours),
        controller_(controller),
        options_(options),
        epoch_(first_epoch(boot)) {}

  // Call once at the start: the place where the AGV stands, and the lane that it is driving, if any. The AGV holds this
  // path.
  void stand(const Path& standing) { held_ = standing; }
  // While the AGV does not know for certain what it covers, it grants nothing. Requires: nothing is requested
  // meanwhile.
  void know_own_place(bool known);
  const Path& held() const { return held_; }
  bool requesting() const { return requesting_; }
  const Path& requested() const { return request_; }
  Epoch epoch() const { return epoch_; }

  // Requests `stretch` in addition to the held path. Replaces an open request. `demand_ns`: since when the AGV has
  // wanted to go on. If two AGVs wait for each other, the older demand comes first.
  // False if `stretch` does not begin where the held path ends, or is too long. Nothing is requested then.
  bool request(const Path& stretch, std::int64_t demand_ns);
  void withdraw();
  // True if the held path begins with this lane. The AGV must drive no other lane.
  bool may_drive(std::uint32_t lane) const { return !held_.empty() && held_.lane_ids[0] == lane; }
  // True if this is the second lane of the held path. While the AGV drives the first one, this move may be given.
  bool may_drive_next(std::uint32_t lane) const { return held_.count > 1 && held_.lane_ids[1] == lane; }
  // The AGV has reached the end of the first held lane, and releases that lane. No effect if no lane is held.
  void lane_passed();
  // The state of the AGV that the next messages contain.
  void describe(bool waiting, bool idle, bool out_of_order);

  // False if the bytes are not a message of this protocol.
  bool receive(std::uint32_t sender, std::span<const std::byte> bytes);
  // Call this at the end of every activation. It answers requests that can be answered now, and asks AGVs that have not
  // been asked. True if the request is locked: the held path then contains it.
  bool settle();
  // Sends again what may have been lost: the open request to those who have not answered, and answers to requests that
  // are open. From time to time, and if that is shorter, it tells all AGVs the own state, and all this with it. Call
  // this about once a second.
  void repeat();

  // An AGV that stands and waits inside the hull of `path`; FP_NONE if none is known.
  std::uint32_t waiting_inside(const Path& path);
  // Whether another AGV is known to hold floor inside the hull of `path`.
  bool is_held(const Path& path);

 private:
  // What is to be sent again.
  struct Due {
    std::uint32_t agv;
    bool request, answer;
  };
  enum class Answer : std::uint8_t { Grant, GrantAndStepBack, Defer };

  bool continues_held(const Path& stretch) const;
  void open_epoch();
  void receive_request(std::uint32_t sender, const Message& message);
  void answer_request(std::uint32_t sender);
  bool has_granted(const Neighbour& neighbour) const;
  Answer answer_to(std::uint32_t agv, const Neighbour& neighbour);
  bool lock_is_over();
  bool comes_first(std::uint32_t agv, const Neighbour& neighbour);
  bool is_blocked();
  void grant(std::uint32_t agv, Neighbour& neighbour, Answer answer);
  void give_way_to(Neighbour& neighbour);
  void answer_those_deferred();
  void broadcast_state();
  void fill_in_lists(Message& message);
  double longest_quiet_s() const;
  bool is_unanswered(const Neighbour& neighbour) const;
  bool owes_answer(const Neighbour& neighbour) const;
  void receive_answer(std::uint32_t sender, Epoch echo, bool granted);
  bool consents(std::uint32_t agv, const Neighbour& neighbour, std::int64_t now_ns);
  bool all_consent();
  void note_consent(std::uint32_t agv);
  void ask();
  bool is_asked(const Neighbour& neighbour) const;
  bool has_consent(const Neighbour& neighbour) const;
  Asked::Entry entry_of(std::uint32_t agv) const;
  void send_request(std::uint32_t receiver);
  Message request_message();
  void send_answer(MessageKind kind, std::uint32_t receiver, Epoch echo);
  void send(const Message& message, std::uint32_t receiver);
  void fill_in(Status& status);
  void fill_in_request(Message& message);

  const MapView& map_;
  HullGeometry& geometry_;
  Neighbours& neighbours_;
  Controller& controller_;
  LockOptions options_;

  Path held_;
  bool own_place_known_ = true;
  bool requesting_ = false;
  Path request_;
  std::int64_t demand_ns_ = 0;
  Epoch epoch_;
  bool asked_ = false;                 // every AGV that had to be asked when this epoch began has been asked
  bool look_at_all_ = true;            // consent may be complete, or somebody else may have to be asked
  std::uint32_t missing_ = 0;          // AGVs whose consent this epoch lacks
  std::uint32_t repeated_grants_ = 0;  // of this epoch
  std::vector<std::uint32_t> to_ask_;  // AGVs that must consent and have not been asked by this epoch
  std::vector<Due> due_;
  std::int64_t state_sent_ns_ = -1;
  std::uint32_t first_in_lists_ = 0;  // of a STATE
  std::int64_t locked_at_ns_ = 0;
  bool answers_may_change_ = false;  // something changed since the deferred requests were last examined

  bool blocked_ = false, blocked_is_known_ = false;  // an AGV waits inside the requested hull
  bool waiting_ = true, idle_ = true, out_of_order_ = false;
  Vec position_m_;
  std::int64_t position_at_ns_ = -1;
};

}  // namespace fleetproof::agents
