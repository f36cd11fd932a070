#include "core/agents/message_text.hpp"

#include <algorithm>
#include <charconv>

namespace fleetproof::agents {

MessageText::MessageText(const Message& message) {
  put(name_of(message.kind));
  if (message.has_request()) {
    put(": asks ");
    put_asked(message.status.epoch, message.asked);
  } else if (message.kind != MessageKind::State) {
    put(": answers ");
    put_epoch(message.echo);
  }
  text_[size_] = '\0';
}

void MessageText::put(std::string_view text) {
  std::ranges::copy(text, text_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += text.size();
}

void MessageText::put(std::uint32_t number) {
  char* const begin = text_.data() + size_;
  size_ += static_cast<std::size_t>(std::to_chars(begin, text_.data() + text_.size(), number).ptr - begin);
}

void MessageText::put_epoch(Epoch epoch) {
  put(static_cast<std::uint32_t>(number_of(epoch) / kAttempts));
  put(".");
  put(static_cast<std::uint32_t>(number_of(epoch) % kAttempts));
  if (boot_of(epoch) == 0) return;
  put(" of boot ");
  put(boot_of(epoch));
}

void MessageText::put_asked(Epoch request, const Asked& asked) {
  if (asked.count == 0) {
    put("nobody with ");
    put_epoch(request_of(request));
    return;
  }
  const std::uint32_t named = std::min(asked.count, kNamed);
  for (std::uint32_t i = 0; i < named; ++i) {
    if (i > 0) put(", ");
    put("AGV ");
    put(asked.list[i].agv);
    put(" with ");
    put_epoch(request_of(request) + asked.list[i].attempt);
  }
  if (asked.count > named) put(", ...");
}

}  // namespace fleetproof::agents
