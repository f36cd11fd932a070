#include "campaign/cli/archive_name.hpp"

#include <algorithm>

#include "core/base/outside_text.hpp"

namespace fleetproof::cli {

std::string archive_name_of(std::string_view campaign_name) {
  // The file system takes 255 bytes; names beside the archive end in up to 30 bytes more.
  constexpr std::size_t kLongest = 200;
  std::string name = printable(campaign_name);
  std::ranges::replace(name, '/', '-');
  std::ranges::replace(name, '\\', '-');
  // No hidden file, no "." or "..", and nothing that a program takes for an option.
  name.erase(0, std::min(name.find_first_not_of(".- "), name.size()));
  if (name.size() > kLongest) {
    std::size_t end = kLongest;
    while ((static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;  // at the border of a character
    name.resize(end);
  }
  return (name.empty() ? "campaign" : name) + ".db";
}

}  // namespace fleetproof::cli
