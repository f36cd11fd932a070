#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>

namespace fleetproof {

// The unread messages of an AGV, oldest first. A message is named by its slot in the message pool.
class Inbox {
 public:
  bool empty() const { return read_ == end_; }
  std::span<const std::uint32_t> unread() const { return {slots_.get() + read_, slots_.get() + end_}; }

  void push(std::uint32_t slot) {
    if (end_ == capacity_) make_room();
    slots_[end_++] = slot;
  }
  // Requires: it is not empty.
  std::uint32_t take() {
    const std::uint32_t slot = slots_[read_++];
    if (empty()) clear();
    return slot;
  }
  void clear() { read_ = end_ = 0; }

 private:
  // Out of the way of `push`, which needs it seldom.
  [[gnu::noinline]] void make_room() {
    const std::uint32_t waiting = end_ - read_;
    capacity_ = std::max(16U, 2 * waiting);
    auto more = std::make_unique_for_overwrite<std::uint32_t[]>(capacity_);
    std::ranges::copy(unread(), more.get());
    slots_ = std::move(more);
    read_ = 0;
    end_ = waiting;
  }

  std::unique_ptr<std::uint32_t[]> slots_;
  std::uint32_t read_ = 0, end_ = 0, capacity_ = 0;
};

}  // namespace fleetproof
