#include "generators/text/name_list.hpp"

#include <fmt/format.h>

#include "core/base/outside_text.hpp"

namespace fleetproof {
namespace {

// No name that an importer accepts is longer; other words of a file may be.
constexpr std::size_t kLongestName = 200;

}  // namespace

std::string name_list(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < most; ++i)
    text += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", printable(names[i], kLongestName));
  if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
  return text;
}

}  // namespace fleetproof
