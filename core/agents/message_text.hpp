#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/agents/protocol_messages.hpp"

namespace fleetproof::agents {

// A message of the lock protocol in words, as fp_host::describe takes them: "GRANT: answers 7.0". 7.0 is the first
// attempt of the AGV's 7th request; after a restart "7.0 of boot 1". No AGV is named: readers know them by names, an
// agent by numbers. Each message that is sent is put into words, so this writes into an array.
class MessageText {
 public:
  explicit MessageText(const Message& message);
  const char* c_str() const { return text_.data(); }

 private:
  void put(std::string_view text);
  void put(std::uint32_t number);
  void put_epoch(Epoch epoch);
  void put_asked(Epoch request, const Asked& asked);

  // The attempts with which it asks, each once. More are left out: longer texts are cut by the host anyway.
  static constexpr std::uint32_t kNamed = 3;
  std::array<char, 160> text_;
  std::size_t size_ = 0;
};

}  // namespace fleetproof::agents
