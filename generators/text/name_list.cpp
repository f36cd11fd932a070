#include "generators/text/name_list.hpp"

#include <fmt/format.h>

#include "core/base/outside_text.hpp"

namespace fleetproof {

std::string name_list(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < most; ++i) text += (i == 0 ? "" : ", ") + in_quotes(names[i]);
  if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
  return text;
}

}  // namespace fleetproof
