#include "generators/formats/lif_corridor.hpp"

#include <algorithm>

#include "generators/map/layout_check.hpp"

namespace fleetproof {
namespace {

// The keys of the left and the right side: as two drafts of LIF 2.0 and, between them, VDA 5050 spell them.
constexpr const char* kSides[][2] = {
    {"maximumLeftWidth", "maximumRightWidth"}, {"leftWidth", "rightWidth"}, {"maxLeft", "maxRight"}};

double side_m(const JsonReader& corridor, const char* key) {
  const auto side = corridor.find(key);
  if (side && !(side->number() >= 0.0)) side->refuse("expected a width of 0 m or more");
  return side ? side->number() : 0.0;
}

}  // namespace

double corridor_width_m(const std::vector<JsonReader>& rules) {
  double widest_m = 0.0;
  for (const JsonReader& rule : rules) {
    const auto corridor = rule.find("corridor");
    if (!corridor) continue;
    for (const auto& [left, right] : kSides)
      widest_m = std::max(widest_m, side_m(*corridor, left) + side_m(*corridor, right));
  }
  return std::min(widest_m, kWidestFloor_m);
}

}  // namespace fleetproof
