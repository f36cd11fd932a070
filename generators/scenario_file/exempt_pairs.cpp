#include "generators/scenario_file/exempt_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/base/catalogue.hpp"
#include "generators/text/text_file.hpp"

namespace fleetproof {

std::string fault_of_exempt_pair(const ExemptPair& pair, std::span<const std::string> vehicle_types) {
  const auto is_type = [&](std::string_view name) {
    return std::ranges::find(vehicle_types, name) != vehicle_types.end();
  };
  for (const std::string& name : {pair.one, pair.other}) {
    if (name == kAnyObstacle && is_type(name))
      return fmt::format("{} is a vehicle type here and every obstacle; give the type another name", in_quotes(name));
    if (name == kAnyObstacle || is_type(name)) continue;
    std::vector<std::string_view> known(vehicle_types.begin(), vehicle_types.end());
    known.push_back(kAnyObstacle);
    return fmt::format("{} is no vehicle type of this fleet, nor \"{}\"{}", in_quotes(name), kAnyObstacle,
                       name_hint(name, known));
  }
  if (pair.one == kAnyObstacle && pair.other == kAnyObstacle)
    return "two obstacles are never judged; name a vehicle type";
  return {};
}

std::string fault_of_pair_size(std::size_t names) {
  if (names == 2) return {};
  return fmt::format("{}; a pair is two names, of vehicle types or \"{}\", as in [\"tugger\", \"cart\"]",
                     names < 2 ? "a name is missing" : "a name is too much", kAnyObstacle);
}

std::string text_of(const ExemptPair& pair) { return pair.one + " and " + pair.other; }

}  // namespace fleetproof
