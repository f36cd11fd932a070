#include "core/base/error.hpp"

#include "core/base/outside_text.hpp"

namespace fleetproof {
namespace {

// An error quotes words of a file, and they may be megabytes long. The middle is left out, at the borders of
// characters.
std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 1500, kBegin = 1000, kEnd = 400;
  if (text.size() <= kLongest) return text;
  const auto continues = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80; };
  std::size_t begin = kBegin, end = text.size() - kEnd;
  while (begin > 0 && continues(begin)) --begin;
  while (end < text.size() && continues(end)) ++end;
  return text.substr(0, begin) + " ... " + text.substr(end);
}

}  // namespace

InputError::InputError(std::string_view where, std::string_view what)
    : std::runtime_error(
          shortened(printable(where.empty() ? std::string(what) : std::string(where) + ": " + std::string(what)))) {}

void invariant_violated(const char* sentence) { throw InvariantViolation(sentence); }

}  // namespace fleetproof
