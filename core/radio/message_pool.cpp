#include "core/radio/message_pool.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>

namespace fleetproof {

[[gnu::noinline]] void MessageBytes::make_room(std::size_t bytes) {
  room_ = static_cast<std::uint32_t>(std::max<std::size_t>(bytes, 2 * room_));
  bytes_ = std::make_unique_for_overwrite<char[]>(room_);
}

std::uint32_t MessagePool::add(AgvId sender, std::string_view bytes, std::uint32_t copies) {
  std::uint32_t slot = free_;
  if (slot == kNone) {
    slot = static_cast<std::uint32_t>(messages_.size());
    messages_.emplace_back();
  } else {
    free_ = messages_[slot].next_free;
  }
  Message& message = messages_[slot];
  message.sender = sender;
  message.bytes.assign(bytes);
  message.hash = XXH3_64bits(bytes.data(), bytes.size());
  message.copies = copies;
  message.spared = false;
  if (!destroyed_.empty()) [[unlikely]]
    forget_destroyed(slot);
  return slot;
}

[[gnu::noinline]] void MessagePool::forget_destroyed(std::uint32_t slot) {
  destroyed_.erase(destroyed_.lower_bound({slot, AgvId{0U}}), destroyed_.lower_bound({slot + 1, AgvId{0U}}));
}

}  // namespace fleetproof
