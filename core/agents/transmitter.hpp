#pragma once

#include <cstdint>

#include "core/agents/controller.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/protocol_messages.hpp"

namespace fleetproof::agents {

// Sends messages of the lock protocol, with what each of them says about the AGV itself.
class Transmitter {
 public:
  // `self`: the AGV; `boot`: of its computer. Requires: the map outlives the object.
  Transmitter(const MapView& map, Controller& controller, std::uint32_t self, std::uint32_t boot)
      : map_(map), controller_(controller), self_(self), boot_(boot) {}

  // The state of the AGV that the next messages contain.
  void describe(bool waiting, bool idle, bool out_of_order);
  // That state as one number, with whether the request is blocked or held up.
  std::uint8_t condition(bool blocked, bool held_up) const {
    return static_cast<std::uint8_t>((waiting_ ? 1U : 0U) | (idle_ ? 2U : 0U) | (out_of_order_ ? 4U : 0U) |
                                     (blocked ? 8U : 0U) | (held_up ? 16U : 0U));
  }
  // Fills in that state, the instant and the position.
  void fill_in(Status& status);
  // The next messages say something new: they get a stamp that no message of this boot had before, which may be ahead
  // of the clock by a few milliseconds. Returns the first stamp of which it is certain that no message had it, those of
  // a former self included.
  std::uint32_t begin_new_stamp();
  // To all AGVs if the receiver is FP_NONE.
  void send(const Message& message, std::uint32_t receiver);

 private:
  const MapView& map_;
  Controller& controller_;
  std::uint32_t self_, boot_;
  std::uint32_t first_unused_ms_ = 0;  // by a former self; 0: not known yet
  bool waiting_ = true, idle_ = true, out_of_order_ = false;
  Vec position_m_;
  std::int64_t position_at_ns_ = -1;
  std::uint32_t stamp_ms_ = 0;  // the next message has this one or a later one
};

}  // namespace fleetproof::agents
