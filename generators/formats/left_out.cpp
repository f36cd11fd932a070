#include "generators/formats/left_out.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generators/text/name_list.hpp"

namespace fleetproof {

void LeftOutThings::add(const Topic& topic, const std::string& place, const std::string& name) {
  auto found = std::ranges::find(found_, &topic, &Found::topic);
  if (found == found_.end()) found = found_.insert(found_.end(), {&topic, place, {}, {}});
  if (found->known.insert(name).second) found->names.push_back(name);
}

void LeftOutThings::tell(std::vector<std::string>& warnings) const {
  for (const auto& [topic, place, names, known] : found_) {
    const std::size_t count = names.size();
    const std::string list = name_list(names);
    warnings.push_back(place + ": " + fmt::vformat(topic->sentence, fmt::make_format_args(count, list)));
  }
}

}  // namespace fleetproof
