#include "campaign/shrink/trial_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "core/base/error.hpp"
#include "generators/text/text_file.hpp"
#include "generators/text/text_lines.hpp"
#include "storage/line_log.hpp"

namespace fleetproof {
namespace {

constexpr std::string_view kTrialsBeginning = "fleetproof trials of ";
constexpr std::size_t kDigits = 16;

}  // namespace

TrialFile::TrialFile(std::string path, const std::string& identity) : path_(std::move(path)) {
  const std::string heading = std::string(kTrialsBeginning) + identity;
  read(heading);
  if (!is_name_taken(path_)) append_lines(path_, heading + "\n");
}

// A last line without its end was cut off when the program was killed.
void TrialFile::read(const std::string& heading) {
  const std::string text =
      read_log(path_, kTrialsBeginning, "is there already and is no record of trials; name another file by --output");
  if (text.empty()) return;
  std::size_t at = text.find('\n');
  if (at == std::string::npos || text.substr(0, at) != heading) return remove();
  for (std::size_t end = text.find('\n', ++at); end != std::string::npos; at = end + 1, end = text.find('\n', at)) {
    std::uint64_t digest = 0;
    const auto [rest, error] = std::from_chars(text.data() + at, text.data() + end, digest, 16);
    if (error == std::errc() && end - at == kDigits + 2) TrialCache::add(digest, rest[1] == '1');
  }
}

void TrialFile::add(std::uint64_t digest, bool fails) {
  TrialCache::add(digest, fails);
  const std::lock_guard lock(mutex_);
  append_lines(path_, fmt::format("{:016x} {}\n", digest, fails ? 1 : 0));
}

void TrialFile::remove() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace fleetproof
