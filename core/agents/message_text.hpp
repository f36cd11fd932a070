#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/agents/map_view.hpp"
#include "core/agents/protocol_messages.hpp"

namespace fleetproof::agents {

// A message of the lock protocol in words, as fp_host::describe takes them: "REQUEST: asks with 3.0 for C12 to C14",
// "GRANT: answers 3.0, holds C2 to C4". 3.0 is the first attempt of the AGV's 3rd request; after a restart "3.0 of boot
// 1". Places are the first and the last station of a path. No AGV is named: readers know them by names, an agent by
// numbers. Each message that is sent is put into words, whether somebody reads it or not: this has to be quick.
class MessageText {
 public:
  // A trace keeps so many bytes. Numbers come first; what has no room is cut or left out.
  static constexpr std::size_t kBytes = 64;

  MessageText(const Message& message, const MapView& map);
  const char* c_str() const { return text_.data(); }

 private:
  std::array<char, 128> text_;
};

// The requests that a message makes and answers, as fp_message_fields has them: "2/3" is the 3rd request of AGV 2, with
// all its attempts; after a restart "2/3 of boot 1". Either may be empty.
class RequestNames {
 public:
  // `self` sends the message to `receiver`; FP_NONE: to all.
  RequestNames(const Message& message, std::uint32_t self, std::uint32_t receiver);
  const char* asks() const { return asks_.data(); }
  const char* answers() const { return answers_.data(); }

 private:
  std::array<char, 48> asks_;
  std::array<char, 128> answers_;
};

}  // namespace fleetproof::agents
