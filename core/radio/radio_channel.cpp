#include "core/radio/radio_channel.hpp"

#include "core/base/random.hpp"

namespace fleetproof {

RadioChannel::RadioChannel(const RadioSetup& setup, std::uint64_t world_seed, DrawNumbers numbers)
    : contention_window_(setup.contention.contention_window),
      key_(stream_key(world_seed, Stream::RadioBackoff)),
      numbers_(std::move(numbers)) {}

AirInterval RadioChannel::contend(AgvId sender, SimTime sent, std::uint32_t ordinal, Duration air_time) {
  const Duration slot = std::max(air_time, Duration{1});
  longest_ = std::max(longest_, slot);
  // Later questions concern transmissions that end now or later. Those began after `sent - longest_`. A transmission
  // that ended by then overlaps none of them.
  while (!on_air_.empty() && on_air_.begin()->second <= sent - longest_) on_air_.erase(on_air_.begin());
  if (free_from_.size() <= sender.index()) free_from_.resize(sender.index() + 1, kStart);
  const auto t = static_cast<std::uint64_t>(to_ns(sent));
  const auto block = philox(
      key_, {static_cast<std::uint32_t>(t), static_cast<std::uint32_t>(t >> 32), numbers_.of(sender).value, ordinal});
  const auto backoff =
      static_cast<std::int64_t>(((word64(block, 0) >> 32) * (std::uint64_t{contention_window_} + 1)) >> 32);
  SimTime& free_from = free_from_[sender.index()];
  const std::int64_t slot_of_sending = sent.time_since_epoch() / slot;
  const std::int64_t first_free_slot = (free_from.time_since_epoch() + slot - Duration{1}) / slot;
  const SimTime begin = kStart + slot * (std::max(slot_of_sending + 1, first_free_slot) + backoff);
  free_from = begin + slot;
  on_air_.emplace(std::pair(begin, sender), free_from);
  return {begin, free_from};
}

}  // namespace fleetproof
