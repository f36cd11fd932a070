#pragma once

#include <cstdint>

#include "core/base/random.hpp"
#include "core/base/sim_time.hpp"
#include "core/base/strong_id.hpp"

namespace fleetproof {

// Identifies one message at one receiver. All draws for its delivery depend on this key and the seed, and on nothing
// else.
struct MessageKey {
  AgvId sender, receiver;
  SimTime sent{};
  // How many messages this sender has sent before at that instant: those to all, and those that only this receiver
  // heard.
  std::uint32_t ordinal = 0;
};

inline Block counter_of(const MessageKey& message) {
  const auto t = static_cast<std::uint64_t>(to_ns(message.sent));
  return {static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(t >> 32),
          (message.sender.value << 16) | message.receiver.value, message.ordinal};
}

inline Block draw_for(const MessageKey& message, std::uint64_t key) { return philox(key, counter_of(message)); }

}  // namespace fleetproof
