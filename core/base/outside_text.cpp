#include "core/base/outside_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace fleetproof {
namespace {

struct CodePoint {
  char32_t value = 0;
  std::size_t length = 1;  // in bytes
  bool valid = false;
};

unsigned char byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

// The UTF-8 sequence that starts at byte i; one byte that is not valid if there is none.
CodePoint code_point_at(std::string_view text, std::size_t i) {
  const unsigned char lead = byte_at(text, i);
  if (lead < 0x80) return {lead, 1, true};
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || i + length > text.size()) return {};
  char32_t value = lead & (0x7fU >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte_at(text, i + k) & 0xc0) != 0x80) return {};
    value = value << 6 | (byte_at(text, i + k) & 0x3fU);
  }
  const bool overlong = (length == 3 && value < 0x800) || (length == 4 && value < 0x10000);
  const bool outside = (value >= 0xd800 && value <= 0xdfff) || value > 0x10ffff;
  return overlong || outside ? CodePoint{} : CodePoint{value, length, true};
}

bool is_control(char32_t c) { return c < 0x20 || (c >= 0x7f && c <= 0x9f); }

struct Range {
  char32_t first, last;
};

// Unicode 15, sorted: the general categories Cf, Zl and Zp; other characters that a page does not draw
// (Default_Ignorable_Code_Point); U+FFFE and U+FFFF, which XML forbids.
constexpr Range kUnseen[] = {
    {0x00ad, 0x00ad},   {0x034f, 0x034f},   {0x0600, 0x0605},   {0x061c, 0x061c},   {0x06dd, 0x06dd},
    {0x070f, 0x070f},   {0x0890, 0x0891},   {0x08e2, 0x08e2},   {0x115f, 0x1160},   {0x17b4, 0x17b5},
    {0x180b, 0x180f},   {0x200b, 0x200f},   {0x2028, 0x202e},   {0x2060, 0x206f},   {0x3164, 0x3164},
    {0xfe00, 0xfe0f},   {0xfeff, 0xfeff},   {0xffa0, 0xffa0},   {0xfff0, 0xfffb},   {0xfffe, 0xffff},
    {0x110bd, 0x110bd}, {0x110cd, 0x110cd}, {0x13430, 0x1343f}, {0x1bca0, 0x1bca3}, {0x1d173, 0x1d17a},
    {0xe0000, 0xe0fff},
};

bool is_unseen(char32_t c) {
  const auto* const range = std::ranges::lower_bound(kUnseen, c, {}, &Range::last);
  return range != std::end(kUnseen) && c >= range->first;
}

std::string escape_of(std::string_view text, std::size_t i, const CodePoint& point) {
  if (!point.valid) return fmt::format("\\x{:02x}", byte_at(text, i));
  switch (point.value) {
    case U'\n':
      return "\\n";
    case U'\r':
      return "\\r";
    case U'\t':
      return "\\t";
    default:
      break;
  }
  const auto value = static_cast<std::uint32_t>(point.value);
  if (value < 0x80) return fmt::format("\\x{:02x}", value);
  return value <= 0xffff ? fmt::format("\\u{:04x}", value) : fmt::format("\\u{{{:x}}}", value);
}

// As JSON writes a character: beyond 16 bits as a surrogate pair.
std::string json_escape_of(const CodePoint& point) {
  const auto value = static_cast<std::uint32_t>(point.value);
  if (value <= 0xffff) return fmt::format("\\u{:04x}", value);
  return fmt::format("\\u{:04x}\\u{:04x}", 0xd800 + ((value - 0x10000) >> 10), 0xdc00 + ((value - 0x10000) & 0x3ff));
}

bool is_shown(const CodePoint& point) { return point.valid && !is_control(point.value) && !is_unseen(point.value); }

bool is_plain_in_a_shell(std::string_view word) {
  return !word.empty() && !word.starts_with('-') && std::ranges::all_of(word, [](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view("_-./+:@%,").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

// $'...': the shell turns the escapes back into the bytes.
std::string ansi_quoted(std::string_view word) {
  std::string quoted = "$'";
  for (std::size_t i = 0; i < word.size();) {
    const CodePoint point = code_point_at(word, i);
    for (std::size_t k = i; k < i + point.length; ++k) {
      if (word[k] == '\'' || word[k] == '\\') quoted += '\\';
      // Three octal digits: a hexadecimal escape would take the next letter for a digit of its own.
      quoted += is_shown(point) ? std::string(1, word[k]) : fmt::format("\\{:03o}", byte_at(word, k));
    }
    i += point.length;
  }
  return quoted + "'";
}

}  // namespace

std::string printable(std::string_view text, std::size_t most_characters) {
  std::string line;
  std::size_t shown = 0;
  for (std::size_t i = 0; i < text.size();) {
    const CodePoint point = code_point_at(text, i);
    const std::string escape = is_shown(point) ? std::string() : escape_of(text, i, point);
    shown += std::max<std::size_t>(1, escape.size());
    if (shown > most_characters) return line + "...";
    line += escape.empty() ? text.substr(i, point.length) : std::string_view(escape);
    i += point.length;
  }
  return line;
}

std::string printable_lines(std::string_view text) {
  std::string lines;
  for (;;) {
    const auto end = text.find('\n');
    lines += printable(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    lines += '\n';
    text.remove_prefix(end + 1);
  }
}

std::string printable_json(std::string_view json) {
  std::string out;
  out.reserve(json.size());
  for (std::size_t i = 0; i < json.size();) {
    const CodePoint point = code_point_at(json, i);
    if (!point.valid || is_shown(point) || point.value == U'\n') {
      out += json.substr(i, point.length);
    } else {
      out += json_escape_of(point);
    }
    i += point.length;
  }
  return out;
}

bool is_plain_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const CodePoint point = code_point_at(text, i);
    if (!point.valid || is_control(point.value)) return false;
    i += point.length;
  }
  return true;
}

std::string in_quotes(std::string_view value) {
  constexpr std::size_t kLongest = 60;
  return "\"" + printable(value, kLongest) + "\"";
}

std::string shell_word(std::string_view word) {
  if (is_plain_in_a_shell(word)) return std::string(word);
  const std::string whole = (word.starts_with('-') ? "./" : "") + std::string(word);
  if (printable(whole) != whole) return ansi_quoted(whole);
  std::string quoted = "'";
  for (const char c : whole) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace fleetproof
