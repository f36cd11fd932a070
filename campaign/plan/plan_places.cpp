#include "campaign/plan/plan_places.hpp"

#include <algorithm>

namespace fleetproof {

// "vehicle.speed_mps" of "vehicle.1.speed_mps".
std::string without_numbers(std::string_view path) {
  std::string text;
  while (!path.empty()) {
    const auto word = path.substr(0, path.find('.'));
    path.remove_prefix(std::min(word.size() + 1, path.size()));
    if (std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; })) continue;
    if (!text.empty()) text += '.';
    text += word;
  }
  return text;
}

std::string PlanPlaces::of(std::string path) const {
  while (!path.empty()) {
    // One [vehicle] is not an array: what the plan calls "vehicle.0.speed_mps" is "vehicle.speed_mps" there.
    for (const std::string& word : {path, without_numbers(path)}) {
      if (const auto found = known.find(word); found != known.end()) return found->second;
    }
    const auto dot = path.rfind('.');
    path.resize(dot == std::string::npos ? 0 : dot);
  }
  return file;
}

}  // namespace fleetproof
