#include "core/base/error.hpp"

namespace fleetproof {

namespace {

// Words of a file stand in it, and they may be megabytes: their middle is left out, at the borders of UTF-8 sequences.
std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 1500, kBegin = 1000, kEnd = 400;
  if (text.size() <= kLongest) return text;
  const auto continues = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80; };
  std::size_t begin = kBegin, end = text.size() - kEnd;
  while (begin > 0 && continues(begin)) --begin;
  while (end < text.size() && continues(end)) ++end;
  return text.substr(0, begin) + " ... " + text.substr(end);
}

// What would move the cursor, ring or colour a terminal is shown as a question mark.
std::string printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

}  // namespace

InputError::InputError(std::string_view where, std::string_view what)
    : std::runtime_error(
          printable(shortened(where.empty() ? std::string(what) : std::string(where) + ": " + std::string(what)))) {}

void invariant_violated(const char* sentence) { throw InvariantViolation(sentence); }

}  // namespace fleetproof
