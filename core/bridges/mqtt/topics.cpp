#include "core/bridges/mqtt/topics.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace fleetproof::mqtt {
namespace {

// How many bytes a code point has that begins so; 0: none begins so.
std::size_t length_of(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return 2;
  if (first >= 0xe0 && first <= 0xef) return 3;
  return first >= 0xf0 && first <= 0xf4 ? 4 : 0;
}

// The second byte tells shorter forms, surrogates and what lies above U+10FFFF.
bool is_second(unsigned char first, unsigned char second) {
  const unsigned char least = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
  const unsigned char most = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
  return second >= least && second <= most;
}

// The first level, taken from the text. `is_last`: there is no further one.
std::string_view take_level(std::string_view& text, bool& is_last) {
  const std::size_t end = text.find('/');
  is_last = end == text.npos;
  const std::string_view level = text.substr(0, end);
  text = is_last ? std::string_view() : text.substr(end + 1);
  return level;
}

}  // namespace

bool is_mqtt_text(std::string_view text) {
  while (!text.empty()) {
    const auto first = static_cast<unsigned char>(text.front());
    const std::size_t length = length_of(first);
    if (first == 0 || length == 0 || length > text.size()) return false;
    if (length > 1 && !is_second(first, static_cast<unsigned char>(text[1]))) return false;
    const auto is_inner = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; };
    if (!std::ranges::all_of(text.substr(1, length - 1), is_inner)) return false;
    text.remove_prefix(length);
  }
  return true;
}

bool is_topic(std::string_view text) { return !text.empty() && text.find_first_of("+#") == text.npos; }

bool is_filter(std::string_view text) {
  if (text.empty()) return false;
  for (bool is_last = false; !is_last;) {
    const std::string_view level = take_level(text, is_last);
    if (level == "+" || (level == "#" && is_last)) continue;
    if (level.find_first_of("+#") != level.npos) return false;
  }
  return true;
}

bool matches(std::string_view filter, std::string_view topic) {
  if (is_of_server(topic) && filter.find_first_of("+#") == 0) return false;
  for (bool filter_ends = false, topic_ends = false;;) {
    const std::string_view wanted = take_level(filter, filter_ends);
    if (wanted == "#") return true;
    if (topic_ends) return false;
    const std::string_view level = take_level(topic, topic_ends);
    if (wanted != "+" && wanted != level) return false;
    if (filter_ends) return topic_ends;
    if (topic_ends && filter != "#") return false;  // "a/#" is for "a", too
  }
}

std::string printable(std::string_view text) {
  constexpr std::size_t kMost = 60;
  std::string shown(text.substr(0, kMost));
  std::ranges::replace_if(
      shown, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > kMost ? shown + "..." : shown;
}

}  // namespace fleetproof::mqtt
