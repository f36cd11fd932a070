#include "generators/formats/lif_corridor.hpp"

#include <algorithm>

namespace fleetproof {
namespace {

// Left and right have no order here. The drafts of LIF 2.0 spell them in two ways, VDA 5050 in a third.
constexpr const char* kSides[] = {"maximumLeftWidth", "maximumRightWidth", "leftWidth",
                                  "rightWidth",       "maxLeft",           "maxRight"};

}  // namespace

double corridor_width_m(const std::vector<JsonReader>& rules) {
  double widest_m = 0.0;
  for (const JsonReader& rule : rules) {
    const auto corridor = rule.find("corridor");
    if (!corridor) continue;
    double width_m = 0.0;
    for (const char* key : kSides) {
      const auto side = corridor->find(key);
      if (side && !(side->number() >= 0.0)) side->refuse("expected a width of 0 m or more");
      if (side) width_m += side->number();
    }
    widest_m = std::max(widest_m, width_m);
  }
  return widest_m;
}

}  // namespace fleetproof
