#pragma once

#include <cstdint>
#include <span>

#include "core/agents/blocker.hpp"
#include "core/agents/controller.hpp"
#include "core/agents/lock_claim.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/neighbours.hpp"
#include "core/agents/protocol_messages.hpp"
#include "core/agents/transmitter.hpp"
#include "core/agents/zone_set.hpp"

namespace fleetproof::agents {

// Puts together the messages of the lock protocol and sends them.
class LockMessages {
 public:
  // `asks_again`: a STATE repeats a request that has no answer. Requires: what is referred to outlives the object.
  LockMessages(const MapView& map, Controller& controller, std::uint32_t boot, Neighbours& neighbours,
               const Claim& claim, Blocker& blocker, bool asks_again)
      : controller_(controller),
        transmitter_(map, controller, neighbours.self(), boot),
        neighbours_(neighbours),
        claim_(claim),
        blocker_(blocker),
        asks_again_(asks_again) {}

  // The state of the AGV that the next messages contain.
  void describe(bool waiting, bool idle, bool out_of_order) { transmitter_.describe(waiting, idle, out_of_order); }
  // Transmitter::begin_new_stamp.
  std::uint32_t begin_new_stamp() { return transmitter_.begin_new_stamp(); }

  // To those that must consent; one message to all if they are many: it is one transmission.
  void ask(std::span<const std::uint32_t> agvs);
  void send_request(std::uint32_t receiver);
  // To the newest request of the receiver.
  void send_answer(MessageKind kind, std::uint32_t receiver);
  // A STATE to all, with a part of what is owed to each.
  void broadcast_state();
  // How long ago that was; infinite if it never was.
  double quiet_s() const;
  // A STATE with what concerns one AGV.
  void tell(std::uint32_t receiver, bool wants_answer);
  // Whether the newest message to an AGV is so old, or there is so much news since, that it is told again.
  bool is_to_be_told(const Neighbour& n, std::int64_t now_ns);

  // A message that says what each of them does.
  Message begin(MessageKind kind);
  void send_to(std::uint32_t receiver, Message& message);

 private:
  void fill_in_request(Message& message) const;
  void fill_in_lists(Message& message);
  bool is_blocked() { return claim_.requesting && blocker_.is_blocked(claim_.request); }
  bool is_held_up() { return claim_.requesting && blocker_.is_held_up(claim_.request); }
  void note_told(Neighbour& n, const Message& message);

  Controller& controller_;
  Transmitter transmitter_;
  Neighbours& neighbours_;
  const Claim& claim_;
  Blocker& blocker_;
  bool asks_again_;
  std::int64_t state_sent_ns_ = -1;
  std::uint32_t first_in_lists_ = 0;  // of a STATE to all
};

}  // namespace fleetproof::agents
