#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario.hpp"

namespace fleetproof {

// What becomes of one transmission at one receiver.
struct Fate {
  bool lost = false;
  Duration delay{};  // from sending to the inbox; for a lost one too, so that losses shift nothing
};

// The radio as a function of (sender, receiver, instant, number among the messages of that instant): one message more moves no other's fate, and
// a higher loss rate only adds losses. Threads: any.
class Radio {
 public:
  Radio(const RadioSetup& setup, std::uint64_t world_seed);
  Fate fate(AgvId sender, AgvId receiver, SimTime sent, std::uint32_t ordinal) const;

 private:
  RadioSetup setup_;
  std::uint64_t key_;
  Duration floor_;
};

// A message in the air or in inboxes.
struct Message {
  AgvId sender;
  std::string bytes;
  std::uint64_t hash = 0;
  std::uint32_t copies = 0;  // receptions still under way or unread
};

// Messages by slot; a slot is used again when its last copy has been read or lost.
class MessagePool {
 public:
  std::uint32_t add(AgvId sender, std::string_view bytes, std::uint32_t copies);
  const Message& operator[](std::uint32_t slot) const { return messages_[slot]; }
  void release(std::uint32_t slot);
  // Of a message that is never going to be sent: all its copies.
  void release_unsent(std::uint32_t slot);

 private:
  std::vector<Message> messages_;
  std::vector<std::uint32_t> free_;
};

}  // namespace fleetproof
