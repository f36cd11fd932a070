#include "generators/text/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "core/base/error.hpp"

namespace fleetproof {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{64} << 20;

unsigned char byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

// Bytes of the UTF-8 sequence that starts at i; 0 if there is none.
std::size_t sequence_length(std::string_view text, std::size_t i) {
  const unsigned char lead = byte_at(text, i);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || i + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte_at(text, i + k) & 0xc0) != 0x80) return 0;
  }
  const unsigned char second = byte_at(text, i + 1);
  const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
  const bool outside =
      (lead == 0xed && second > 0x9f) || (lead == 0xf4 && second > 0x8f);  // surrogates; beyond U+10FFFF
  return overlong || outside ? 0 : length;
}

}  // namespace

std::string read_text_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path, "there is no such file");
  if (std::filesystem::is_directory(status)) throw InputError(path, "is a directory; name a file in it");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path, "cannot be opened; check its permissions");
  std::string text;
  char buffer[65536];
  while (in.read(buffer, sizeof buffer), in.gcount() > 0) {
    text.append(buffer, static_cast<std::size_t>(in.gcount()));
    if (text.size() > kLargestFile)
      throw InputError(path, "is larger than 64 MiB, which no layout or scenario is; check the file name");
  }
  if (in.bad()) throw InputError(path, "cannot be read to its end; check the disk");
  return text;
}

TextPosition position_in(std::string_view text, std::size_t offset) {
  const auto before = text.substr(0, std::min(offset, text.size()));
  const auto last_break = before.rfind('\n');
  const auto breaks = static_cast<std::size_t>(std::ranges::count(before, '\n'));
  return {breaks + 1, before.size() - (last_break == std::string_view::npos ? 0 : last_break + 1) + 1};
}

std::string at_line(std::string_view source, std::size_t line) { return fmt::format("{}:{}", source, line); }

std::string in_quotes(std::string_view value) {
  constexpr std::size_t kLongest = 60;
  std::string text = "\"";
  for (const char c : value.substr(0, kLongest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (value.size() > kLongest ? "...\"" : "\"");
}

bool is_plain_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto length = sequence_length(text, i);
    if (length == 0) return false;
    i += length;
  }
  return true;
}

}  // namespace fleetproof
