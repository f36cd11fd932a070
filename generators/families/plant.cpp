#include "generators/families/plant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "generators/families/layout_builder.hpp"
#include "generators/families/plant_zone.hpp"

namespace fleetproof {
namespace {

constexpr std::uint32_t kStationsOfAZone = 400, kFewestWithTwoZones = 180, kFewestWithTwoLanes = 80,
                        kFewestWithBays = 40, kStationsOfASlot = 45;
constexpr std::int64_t kStreet_mm = 10'000;       // from a zone to the one above it, beyond both mouths
constexpr std::int64_t kCorridorStep_mm = 3'500;  // between stations in a corridor, about

// Zones in rows; the numbering turns round at the end of each row, so that a zone is beside the next one.
struct Grid {
  std::uint32_t zones = 1, columns = 1;

  std::uint32_t row(std::uint32_t zone) const { return zone / columns; }
  std::uint32_t column(std::uint32_t zone) const {
    const std::uint32_t n = zone % columns;
    return row(zone) % 2 == 0 ? n : columns - 1 - n;
  }
};

Grid grid_of(std::uint32_t stations) {
  Grid grid;
  if (stations >= kFewestWithTwoZones) grid.zones = std::max(2U, (stations + kStationsOfAZone / 2) / kStationsOfAZone);
  if (grid.zones == 2) grid.columns = 2;
  while (grid.zones > 2 && 2 * grid.columns * grid.columns < grid.zones) ++grid.columns;
  return grid;
}

ZoneShape shape_of(std::uint32_t stations, const Grid& grid) {
  ZoneShape shape;
  const std::uint32_t each = stations / grid.zones;
  shape.slots = std::clamp((each + kStationsOfASlot / 2) / kStationsOfASlot, 1U, 12U);
  shape.has_outer_lane = each >= kFewestWithTwoLanes || grid.zones > 1;
  shape.has_bays = each >= kFewestWithBays;
  if (grid.zones > 2) shape.free_slot = shape.slots++ / 2;
  return shape;
}

class Plant {
 public:
  Plant(Draws& draws, const PlantKnobs& knobs, std::string name, std::uint32_t stations, std::uint32_t stops)
      : draws_(draws),
        knobs_(knobs),
        grid_(grid_of(stations)),
        shape_(shape_of(stations, grid_)),
        stops_(stops),
        builder_(std::move(name)) {
    shape_.most_stops = (stops + halves() - 1) / halves();
  }

  void build() {
    for (std::uint32_t i = 0; i < grid_.zones; ++i)
      zones_.emplace_back(builder_, draws_, knobs_, shape_, fmt::format("Z{}", i + 1), corner(i));
    for (std::uint32_t i = 0; i < grid_.zones; ++i) zones_[i].build(stops_of(i));
    for (std::uint32_t i = 1; i < grid_.zones; ++i) link(i);
    for (auto& zone : zones_) zone.finish();
  }

  std::uint32_t station_count() const { return static_cast<std::uint32_t>(builder_.station_count()); }
  Layout take() { return builder_.take(); }

 private:
  std::uint32_t halves_of_a_zone() const { return 2 * (shape_.slots - (shape_.free_slot < 0 ? 0 : 1)); }
  std::uint32_t halves() const { return grid_.zones * halves_of_a_zone(); }

  // The stops of all aisles differ by one at most.
  std::vector<std::uint32_t> stops_of(std::uint32_t zone) const {
    std::vector<std::uint32_t> stops;
    for (std::uint32_t i = 0; i < halves_of_a_zone(); ++i) {
      const std::uint32_t half = i * grid_.zones + zone;
      stops.push_back(stops_ / halves() + (half < stops_ % halves() ? 1 : 0));
    }
    return stops;
  }

  std::int64_t beyond() const { return 2 * (shape_.lane_pitch(knobs_) + knobs_.mouth_radius); }
  PointMm corner(std::uint32_t zone) const {
    return {grid_.column(zone) * (shape_.width(knobs_) + beyond() + knobs_.corridor),
            grid_.row(zone) * (shape_.height(knobs_) + beyond() + kStreet_mm)};
  }

  // To the zone before; and unless the plant has bottlenecks, a second corridor beside it, or to the zone below.
  void link(std::uint32_t zone) {
    const std::uint32_t before = zone - 1;
    if (grid_.row(zone) == grid_.row(before)) {
      const bool eastwards = grid_.column(before) < grid_.column(zone);
      const std::uint32_t west = eastwards ? before : zone, east = eastwards ? zone : before;
      const std::int64_t aside = knobs_.mouth_radius + 500;
      if (knobs_.bottleneck) {
        corridor(west, PlantRing::East, east, PlantRing::West, 0);
      } else {
        corridor(west, PlantRing::East, east, PlantRing::West, aside);
        corridor(west, PlantRing::East, east, PlantRing::West, -aside);
      }
    }
    for (std::uint32_t below = 0; below < zone; ++below) {
      const bool next_to = grid_.row(below) + 1 == grid_.row(zone) && grid_.column(below) == grid_.column(zone);
      if (next_to && (below == before || !knobs_.bottleneck))
        corridor(below, PlantRing::North, zone, PlantRing::South, 0);
    }
  }

  void corridor(std::uint32_t a, PlantRing::Side from, std::uint32_t b, PlantRing::Side to, std::int64_t aside) {
    const bool crosses = knobs_.all_mouths_cross && aside == 0;
    const StationId begin = zones_[a].corridor(from, aside, crosses), end = zones_[b].corridor(to, aside, crosses);
    const PointMm p = builder_.position(begin), q = builder_.position(end);
    const std::int64_t length = (q.x - p.x) + (q.y - p.y), steps = length / kCorridorStep_mm + 1;
    StationId last = begin;
    for (std::int64_t i = 1; i < steps; ++i) {
      const PointMm at{p.x + (q.x - p.x) * i / steps, p.y + (q.y - p.y) * i / steps};
      const StationId made = builder_.station(fmt::format("C{}", ++corridor_stations_), at);
      builder_.straight(last, made);
      last = made;
    }
    builder_.straight(last, end);
  }

  Draws& draws_;
  const PlantKnobs& knobs_;
  Grid grid_;
  ZoneShape shape_;
  std::uint32_t stops_;
  LayoutBuilder builder_;
  std::vector<PlantZone> zones_;
  std::uint32_t corridor_stations_ = 0;
};

std::string name_of_plant(const PlantWish& wish) {
  if (wish.provocation) return fmt::format("plant/{}", name_of(*wish.provocation));
  return family_name("plant", wish.range);
}

}  // namespace

std::uint32_t fewest_stations(Provocation provocation) {
  switch (provocation) {
    case Provocation::BackIn:
      return kFewestStations;
    case Provocation::TightGap:  // in passing bays
      return kFewestWithBays;
    case Provocation::Crossing:
    case Provocation::CurveBesideLane:
    case Provocation::OverhangPass:
    case Provocation::FourWay:
      return kFewestWithTwoLanes;
    case Provocation::Bottleneck:
      return kFewestWithTwoZones;
  }
  return kMostStations;
}

std::uint32_t plant_stations(std::uint32_t fleet_size) {
  return std::clamp(std::min(fleet_size, kMostStationsOfFleet) * kStationsPerAgv, kFewestStations,
                    kMostStationsOfFleet);
}

// The stops fill up what the rest of the plant leaves of its stations. A first plant, without stops, counts the rest.
// With stops its rings are longer and get more stations: a second plant counts those.
Layout make_plant(Draws& draws, const PlantWish& wish) {
  const PlantKnobs knobs = draw_plant_knobs(draws, wish);
  const auto count = [&](std::uint32_t stops) {
    Draws same = draws;
    Plant trial(same, knobs, "", wish.stations, stops);
    trial.build();
    return trial.station_count();
  };
  std::uint32_t stops = wish.stations - std::min(wish.stations, count(0));
  stops -= std::min(stops, std::max(count(stops), wish.stations) - wish.stations);
  Plant plant(draws, knobs, name_of_plant(wish), wish.stations, stops);
  plant.build();
  return plant.take();
}

Layout make_plant(Draws& draws, Range range) {
  PlantWish wish;
  wish.range = range;
  return make_plant(draws, wish);
}

}  // namespace fleetproof
