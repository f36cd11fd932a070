#include <fmt/format.h>

#include "generators/families/families.hpp"
#include "generators/families/layout_builder.hpp"

namespace fleetproof {
namespace {

// The stress range of aisle-grid: one cross aisle, from which 4-10 two-way aisles, 2.8-4 m apart, lead into dead ends.
// AGVs pick goods in the aisle. An AGV that picks therefore blocks its aisle, and two AGVs cannot pass each other
// there. Parking and charging stations are spurs before the cross aisle.
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

struct GridSizes {
  std::uint32_t aisles, cross_aisles, steps;  // steps: segments of an aisle between two cross aisles
  std::int64_t pitch, spur, aisle_distance;   // millimetres
  std::uint32_t bays, parking, charging, docks;
};

GridSizes draw_grid(Draws& draws) {
  GridSizes s{};
  s.aisles = 4 + draws.below(3);
  s.cross_aisles = draws.below(3) == 0 ? 3 : 2;
  if (s.cross_aisles == 3) {
    s.steps = s.aisles == 4 ? 3 : 2;
  } else {
    s.steps = s.aisles == 6 ? 4 : 4 + draws.below(2);
  }
  s.pitch = draw_between(draws, 3200, 4600, 50);
  s.spur = draw_between(draws, 3000, 3500, 50);
  // Bays of neighbouring aisles face each other: room for a waiting AGV between the two.
  s.aisle_distance = 2 * s.spur + draw_between(draws, 2300, 2700, 100);
  s.bays = 16 + draws.below(5);
  s.parking = 3 + draws.below(3);
  s.charging = 1 + draws.below(2);
  s.docks = 1 + draws.below(2);
  return s;
}

class AisleGrid {
 public:
  explicit AisleGrid(Draws& draws)
      : draws_(draws), sizes_(draw_grid(draws)), rows_((sizes_.cross_aisles - 1) * sizes_.steps + 1) {}

  Layout make() {
    place_aisle_stations();
    place_cross_stations();
    connect();
    add_bays();
    add_services();
    return builder_.take();
  }

 private:
  void place_aisle_stations() {
    for (std::uint32_t i = 0; i < sizes_.aisles; ++i) {
      auto& aisle = aisles_.emplace_back();
      for (std::uint32_t j = 0; j < rows_; ++j) {
        aisle.push_back(
            builder_.station(fmt::format("A{}.{}", i + 1, j), {i * sizes_.aisle_distance, j * sizes_.pitch}));
      }
    }
  }

  // A cross aisle has a station at every aisle and one half-way to the next.
  void place_cross_stations() {
    for (std::uint32_t c = 0; c < sizes_.cross_aisles; ++c) {
      auto& cross = crosses_.emplace_back();
      const std::uint32_t row = c * sizes_.steps;
      for (std::uint32_t i = 0; i < sizes_.aisles; ++i) {
        cross.push_back(aisles_[i][row]);
        if (i + 1 == sizes_.aisles) break;
        const PointMm at{i * sizes_.aisle_distance + sizes_.aisle_distance / 2, row * sizes_.pitch};
        cross.push_back(builder_.station(fmt::format("C{}.{}", c + 1, i + 1), at));
      }
    }
  }

  // The four outer lines form a ring in one direction, and every inner line starts and ends on the ring. The map is
  // therefore strongly connected for all drawn directions.
  void connect() {
    const bool clockwise = draws_.below(2) == 0;
    const Way with = clockwise ? Way::Forward : Way::Backward, against = clockwise ? Way::Backward : Way::Forward;
    for (std::size_t i = 0; i < aisles_.size(); ++i) {
      line(aisles_[i], i == 0 ? outer(with) : i + 1 == aisles_.size() ? outer(against) : inner());
    }
    for (std::size_t c = 0; c < crosses_.size(); ++c) {
      line(crosses_[c], c == 0 ? outer(against) : c + 1 == crosses_.size() ? outer(with) : inner());
    }
  }

  Way outer(Way one_way) { return draws_.below(2) == 0 ? Way::Both : one_way; }
  Way inner() { return outer(draws_.below(2) == 0 ? Way::Forward : Way::Backward); }

  void line(const std::vector<StationId>& stations, Way way) {
    for (std::size_t i = 0; i + 1 < stations.size(); ++i) builder_.straight(stations[i], stations[i + 1], way);
  }

  void spur(StationId from, PointMm to, std::string name, Purpose purpose) {
    builder_.straight(from, builder_.station(std::move(name), to, purpose));
  }

  void add_bays() {
    struct Site {
      std::uint32_t aisle, row;
      bool left;
    };
    std::vector<Site> sites;
    for (std::uint32_t i = 0; i < sizes_.aisles; ++i) {
      for (std::uint32_t j = 0; j < rows_; ++j) {
        if (j % sizes_.steps == 0) continue;
        sites.push_back({i, j, true});
        sites.push_back({i, j, false});
      }
    }
    for (const auto n : draw_some(draws_, sites.size(), sizes_.bays)) {
      const auto [aisle, row, left] = sites[n];
      const StationId from = aisles_[aisle][row];
      const PointMm at = builder_.position(from);
      spur(from, {at.x + (left ? -sizes_.spur : sizes_.spur), at.y},
           fmt::format("B{}.{}{}", aisle + 1, row, left ? "L" : "R"), Purpose::Storage);
    }
  }

  // Parking below the first cross aisle; chargers and docks above the last.
  void add_services() {
    const auto& low = crosses_.front();
    const auto& high = crosses_.back();
    std::uint32_t number = 0;
    for (const auto n : draw_some(draws_, low.size(), sizes_.parking)) {
      spur(low[n], {builder_.position(low[n]).x, -sizes_.spur}, fmt::format("park{}", ++number), Purpose::Parking);
    }
    number = 0;
    for (const auto n : draw_some(draws_, high.size(), sizes_.charging + sizes_.docks)) {
      const PointMm at = builder_.position(high[n]);
      const bool charging = ++number <= sizes_.charging;
      spur(high[n], {at.x, at.y + sizes_.spur},
           charging ? fmt::format("charge{}", number) : fmt::format("dock{}", number - sizes_.charging),
           charging ? Purpose::Charging : Purpose::Storage);
    }
  }

  Draws& draws_;
  GridSizes sizes_;
  std::uint32_t rows_;
  LayoutBuilder builder_{"aisle-grid"};
  std::vector<std::vector<StationId>> aisles_, crosses_;
};

}  // namespace

Layout make_aisle_grid(Draws& draws, Range range) {
  return range == Range::Stress ? make_dead_end_aisles(draws) : AisleGrid(draws).make();
}

}  // namespace fleetproof
