#include "core/radio.hpp"

#include <xxhash.h>

#include <algorithm>

#include "core/random.hpp"

namespace fleetproof {

Radio::Radio(const RadioSetup& setup, std::uint64_t world_seed)
    : setup_(setup), key_(stream_key(world_seed, Stream::Radio)), floor_(seconds(setup.air_time_s)) {}

Fate Radio::fate(AgvId sender, AgvId receiver, SimTime sent, std::uint32_t ordinal) const {
  const auto t = static_cast<std::uint64_t>(to_ns(sent));
  const auto block = philox(key_, {static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(t >> 32), (sender.value << 16) | receiver.value, ordinal});
  Fate fate;
  fate.lost = unit_interval(word64(block, 0)) < setup_.loss;
  const double share = setup_.delay_model == RadioSetup::DelayModel::Uniform ? unit_interval(word64(block, 1)) : 1.0;
  fate.delay = std::max(seconds(setup_.delay_s * share), floor_);
  return fate;
}

std::uint32_t MessagePool::add(AgvId sender, std::string_view bytes, std::uint32_t copies) {
  std::uint32_t slot = 0;
  if (free_.empty()) {
    slot = static_cast<std::uint32_t>(messages_.size());
    messages_.emplace_back();
  } else {
    slot = free_.back();
    free_.pop_back();
  }
  Message& message = messages_[slot];
  message.sender = sender;
  message.bytes.assign(bytes);  // keeps the slot's capacity: no allocation in the steady state
  message.hash = XXH3_64bits(bytes.data(), bytes.size());
  message.copies = copies;
  return slot;
}

void MessagePool::release(std::uint32_t slot) {
  if (--messages_[slot].copies == 0) free_.push_back(slot);
}

void MessagePool::release_unsent(std::uint32_t slot) {
  messages_[slot].copies = 1;
  release(slot);
}

}  // namespace fleetproof
