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

}  // namespace fleetproof
