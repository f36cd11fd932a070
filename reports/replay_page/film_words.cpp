#include "reports/replay_page/film_words.hpp"

#include <fmt/format.h>

namespace fleetproof::web {
namespace {

std::string thousandths(std::int64_t millionths) {
  return fmt::format("{:.3f}", static_cast<double>(millionths - millionths % 1000) / 1e6);
}

}  // namespace

std::string time_text(std::int64_t us) { return thousandths(us); }
std::string metres_text(std::int64_t um) { return thousandths(um); }

const char* word_of(Receipt receipt) {
  constexpr const char* kWords[] = {"received",          "lost by chance",
                                    "lost in an outage", "lost by interference",
                                    "lost to a source",  "lost on purpose by the scenario"};
  return kWords[static_cast<std::size_t>(receipt)];
}

std::string text_of(const Message& message) {
  const std::string name = fmt::format("{} #{}", message.kind, message.number);
  return message.content.empty() ? name : fmt::format("{} ({})", name, message.content);
}

}  // namespace fleetproof::web
