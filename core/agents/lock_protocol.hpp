#pragma once

#include <cstdint>

#include "core/agents/controller.hpp"
#include "core/agents/hull.hpp"
#include "core/agents/neighbours.hpp"
#include "core/agents/path.hpp"
#include "core/agents/protocol_messages.hpp"

namespace fleetproof::agents {

struct LockOptions {
  // A member of the fleet that has answered nothing for so long counts as having granted. 0: silence is never consent,
  // the only safe setting.
  std::int64_t silence_consents_after_ns = 0;
};

// Mutual exclusion of hulls by messages that may be lost, late, reordered or doubled: no two AGVs of a fleet that runs
// this ever hold hulls which conflict. An AGV always holds the path it stands on or drives, and may ask for a longer
// one. Why it is sound stands at the head of the source.
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

  // Where the AGV stands when the agent begins, and the lane it is driving if it is: held from then on.
  void stand(const Path& standing) { held_ = standing; }
  // While it does not know for certain what it covers, it grants nothing to anybody. Nor must anything be requested.
  void know_own_place(bool known);
  const Path& held() const { return held_; }
  bool requesting() const { return requesting_; }
  const Path& requested() const { return request_; }
  Epoch epoch() const { return epoch_; }

  // Wants to hold `stretch`, which begins where the held path ends, as well. Replaces an open request. `demand_ns`:
  // since when it has wanted to go on; of two that wait for each other, the older demand comes first.
  void request(const Path& stretch, std::int64_t demand_ns);
  void withdraw();
  // The first held lane has been driven to its end; its hull is given up. Nothing happens if no lane is held.
  void lane_passed();
  // What the next messages tell about the AGV besides what the protocol knows.
  void describe(bool waiting, bool idle, bool out_of_order);

  // False if these bytes are no message of ours.
  bool receive(std::uint32_t sender, std::span<const std::byte> bytes);
  // To be called at the end of every activation: answers what can be answered now, asks who has not been asked. True:
  // the request is locked, the held path is longer by it.
  bool settle();
  // Asks again who has not granted, if it is time; and says when to call next. Negative: no request is open.
  std::int64_t ask_again();
  void broadcast_state();

  // The AGV that waits, with nothing to do but wait, inside the hull of `path`; FP_NONE if none is known.
  std::uint32_t waiting_inside(const Path& path);

 private:
  enum class Answer : std::uint8_t { Grant, GrantAndStepBack, Defer };

  void open_epoch();
  void answer_request(std::uint32_t sender);
  Answer answer_to(std::uint32_t agv, const Neighbour& neighbour);
  bool is_blocked();
  void grant(std::uint32_t agv, Neighbour& neighbour, Answer answer);
  void answer_those_deferred();
  void receive_answer(std::uint32_t sender, const Message& message);
  bool consents(std::uint32_t agv, const Neighbour& neighbour, std::int64_t now_ns);
  bool all_consent();
  void ask(std::uint32_t agv, Neighbour& neighbour, std::int64_t now_ns);
  std::int64_t jittered(std::int64_t pause_ns);
  void send(MessageKind kind, std::uint32_t receiver, Epoch echo);
  void fill_in(Status& status);

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
  bool asked_ = false;               // in this epoch, whoever had to be asked when it began
  bool answers_may_change_ = false;  // since deferred requests were last looked at

  bool blocked_ = false, blocked_is_known_ = false;  // somebody waits inside the hull it requests
  bool waiting_ = true, idle_ = true, out_of_order_ = false;
  Vec position_m_;
  std::int64_t position_at_ns_ = -1;
};

}  // namespace fleetproof::agents
