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
  if (asked.count == 0) put("nobody ");
  put("with ");
  std::uint32_t named = 0;
  for (std::uint32_t i = 0; i < std::max(asked.count, 1U) && named < kNamed; ++i) {
    const std::uint32_t attempt = asked.count == 0 ? 0 : asked.list[i].attempt;
    const auto same = [&](const Asked::Entry& entry) { return entry.attempt == attempt; };
    if (std::ranges::any_of(asked.all().first(i), same)) continue;
    if (named++ > 0) put(", ");
    put_epoch(request_of(request) + attempt);
  }
}

}  // namespace fleetproof::agents
