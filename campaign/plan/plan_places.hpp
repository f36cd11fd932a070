#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace fleetproof {

// Where a campaign file says what: "law.reaction_s" stands at "c.toml:5:14". Of an array "factors.loss", the items are
// "factors.loss.0" and so on.
struct PlanPlaces {
  std::string file;
  std::map<std::string, std::string, std::less<>> known{};

  // Of the key, or of the nearest table around it that the file has, or the file.
  std::string of(std::string path) const;
};

// How errors write such a path: numbers of items are left out.
std::string without_numbers(std::string_view path);

}  // namespace fleetproof
