#include "core/radio_channel.hpp"

#include <algorithm>

#include "core/random.hpp"

namespace fleetproof {

RadioChannel::RadioChannel(const RadioSetup& setup, std::uint64_t world_seed)
    : slot_(std::max(seconds(setup.air_time_s), Duration{1})),
      contention_window_(setup.contention.contention_window),
      key_(stream_key(world_seed, Stream::RadioBackoff)) {}

std::int64_t RadioChannel::contend(AgvId sender, SimTime sent, std::uint32_t ordinal) {
  const std::int64_t now = slot_at(sent);
  // An event of this instant may still ask about the slot that has just ended.
  while (!senders_.empty() && senders_.begin()->first < now - 1) senders_.erase(senders_.begin());
  if (last_slot_.size() <= sender.index()) last_slot_.resize(sender.index() + 1, -1);
  const auto t = static_cast<std::uint64_t>(to_ns(sent));
  const auto block = philox(key_, {static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(t >> 32), sender.value, ordinal});
  const auto backoff = static_cast<std::int64_t>(((word64(block, 0) >> 32) * (std::uint64_t{contention_window_} + 1)) >> 32);
  std::int64_t& last = last_slot_[sender.index()];
  last = std::max(now, last) + 1 + backoff;
  senders_[last].push_back(sender);
  return last;
}

std::span<const AgvId> RadioChannel::senders_in(std::int64_t slot) const {
  const auto found = senders_.find(slot);
  return found == senders_.end() ? std::span<const AgvId>{} : std::span<const AgvId>(found->second);
}

}  // namespace fleetproof
