#include "generators/families/dead_end_aisles.hpp"

#include <fmt/format.h>

#include "generators/families/layout_builder.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

Layout make_dead_end_aisles(Draws& draws) {
  const std::uint32_t aisles = 4 + draws.below(7), steps = 3 + draws.below(4);
  const std::int64_t distance = draw_between(draws, 2800, 4000, 50), pitch = draw_between(draws, 3000, 5000, 50),
                     spur = draw_between(draws, 3000, 3500, 50);
  const std::uint32_t parking = 2, charging = 1, docks = 1;
  LayoutBuilder builder(family_name("aisle-grid", Range::Stress));
  std::vector<StationId> cross;
  for (std::uint32_t i = 0; i < aisles; ++i) {
    cross.push_back(builder.station(fmt::format("A{}.0", i + 1), {i * distance, 0}));
    if (i > 0) builder.straight(cross[i - 1], cross[i]);
    StationId before = cross[i];
    for (std::uint32_t k = 1; k <= steps; ++k) {
      const StationId here =
          builder.station(fmt::format("A{}.{}", i + 1, k), {i * distance, k * pitch}, Purpose::Storage);
      builder.straight(before, here);
      before = here;
    }
  }
  std::uint32_t number = 0;
  for (const auto n : draw_some(draws, cross.size(), parking + charging + docks)) {
    const PointMm at{builder.position(cross[n]).x, -spur};
    const bool parks = number < parking, charges = number == parking;
    const auto name = parks     ? fmt::format("park{}", number + 1)
                      : charges ? std::string("charge1")
                                : std::string("dock1");
    builder.straight(cross[n], builder.station(name, at,
                                               parks     ? Purpose::Parking
                                               : charges ? Purpose::Charging
                                                         : Purpose::Storage));
    ++number;
  }
  return builder.take();
}

}  // namespace fleetproof
