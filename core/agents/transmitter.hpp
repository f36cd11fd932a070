#pragma once

#include <cstdint>

#include "core/agents/controller.hpp"
#include "core/agents/protocol_messages.hpp"

namespace fleetproof::agents {

// Sends messages of the lock protocol, with what each of them says about the AGV itself.
class Transmitter {
 public:
  explicit Transmitter(Controller& controller) : controller_(controller) {}

  // The state of the AGV that the next messages contain.
  void describe(bool waiting, bool idle, bool out_of_order);
  // Fills in that state, the instant and the position.
  void fill_in(Status& status);
  // The next messages say something new: they get a stamp that no message had before. It is returned, and may be
  // ahead of the clock by a few milliseconds.
  std::uint32_t begin_new_stamp();
  // To all AGVs if the receiver is FP_NONE.
  void send(const Message& message, std::uint32_t receiver);

 private:
  Controller& controller_;
  bool waiting_ = true, idle_ = true, out_of_order_ = false;
  Vec position_m_;
  std::int64_t position_at_ns_ = -1;
  std::uint32_t stamp_ms_ = 0;  // the next message has this one or a later one
};

}  // namespace fleetproof::agents
