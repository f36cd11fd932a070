#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/strong_id.hpp"
#include "core/radio/radio_channel.hpp"

namespace fleetproof {

// The bytes of a message. They stay where they are when the object is moved, unlike those of a short std::string: an
// agent may read a message while it sends others and the pool of messages grows.
class MessageBytes {
 public:
  std::size_t size() const { return size_; }
  const char* data() const { return bytes_.get(); }
  operator std::string_view() const { return {data(), size()}; }
  // Reuses its memory, so that nothing is allocated in the long run.
  void assign(std::string_view bytes) {
    if (bytes.size() >= room_) make_room(bytes.size() + 1);  // of no bytes, too: their address is never null
    bytes.copy(bytes_.get(), bytes.size());
    size_ = static_cast<std::uint32_t>(bytes.size());
  }

 private:
  void make_room(std::size_t bytes);

  std::unique_ptr<char[]> bytes_;
  std::uint32_t size_ = 0, room_ = 0;
};

// A message in the air or in inboxes.
struct Message {
  MessageBytes bytes;
  std::uint64_t hash = 0;
  AirInterval on_air;
  AgvId sender;
  std::uint32_t number = 0;     // in its run, from 1 on; 0: not sent yet
  std::uint32_t copies = 0;     // receptions that are under way or unread
  std::uint32_t next_free = 0;  // of a free slot: the slot that became free before it
  bool spared = false;          // see Radio::delivery
};
static_assert(sizeof(Message) == 64, "the place of a slot is a shift away");

// The messages, by slot. A slot becomes free when the last copy of its message has been read or lost.
class MessagePool {
 public:
  std::uint32_t add(AgvId sender, std::string_view bytes, std::uint32_t copies);
  // Valid until the next `add`.
  Message& operator[](std::uint32_t slot) { return messages_[slot]; }
  const Message& operator[](std::uint32_t slot) const { return messages_[slot]; }
  // With interference: the message has been destroyed at this receiver.
  void destroy_at(std::uint32_t slot, AgvId receiver) { destroyed_.emplace(slot, receiver); }
  bool is_destroyed_at(std::uint32_t slot, AgvId receiver) const { return destroyed_.contains({slot, receiver}); }
  void release(std::uint32_t slot) {
    Message& message = messages_[slot];
    if (--message.copies > 0) return;
    message.next_free = free_;
    free_ = slot;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  void forget_destroyed(std::uint32_t slot);

  std::vector<Message> messages_;
  std::uint32_t free_ = kNone;  // the slot that became free last
  std::set<std::pair<std::uint32_t, AgvId>> destroyed_;
};

}  // namespace fleetproof
