#include "campaign/cli/archive_name.hpp"

#include <algorithm>

#include "core/base/outside_text.hpp"

namespace fleetproof::cli {

std::string archive_name_of(std::string_view campaign_name) {
  // The file system allows 255 bytes. The files beside the archive have names that are up to 30 bytes longer.
  constexpr std::size_t kLongest = 200;
  std::string name = printable(campaign_name);
  std::ranges::replace(name, '/', '-');
  std::ranges::replace(name, '\\', '-');
  // No hidden file, no "." or "..", and no name that looks like an option.
  name.erase(0, std::min(name.find_first_not_of(".- "), name.size()));
  if (name.size() > kLongest) {
    std::size_t end = kLongest;
    while ((static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;  // at the border of a character
    name.resize(end);
  }
  return (name.empty() ? "campaign" : name) + ".db";
}

}  // namespace fleetproof::cli
