#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace fleetproof {

// The places of the keys in a campaign file: "law.reaction_s" stands at "c.toml:5:14". The items of the array
// "factors.loss" are "factors.loss.0", "factors.loss.1" and so on.
struct PlanPlaces {
  std::string file;
  std::map<std::string, std::string, std::less<>> known{};

  // The place of the key. If the file does not have the key: of the nearest table around it, or the file.
  std::string of(std::string path) const;
};

// How errors write such a path: numbers of items are left out.
std::string without_numbers(std::string_view path);

}  // namespace fleetproof
