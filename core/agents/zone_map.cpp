#include "core/agents/zone_map.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/agents/facts.hpp"

namespace fleetproof::agents {
namespace {

constexpr double kZonesOfClaim = 3.0;  // along the longest claim
// Hulls that others work out from a message differ by this, because headings are rounded on the way; at the limit of
// what counts as the same heading, by a whole turn. That does no harm: each contains the floor that its AGV covers.
constexpr double kZoneRounding_m = 0.05;
// Every AGV tells each registrar once that it exists; a registrar that is down holds up a part of the floor.
constexpr std::uint32_t kAgvsPerRegistrar = 64;
constexpr double kMostZones = 60'000.0;  // on the wire they have 16 bits

double largest_reach_m(const HullGeometry& geometry, std::uint32_t fleet_count) {
  double largest_m = 0.0;
  for (std::uint32_t agv = 0; agv < fleet_count; ++agv) largest_m = std::max(largest_m, geometry.reach_m(agv));
  return largest_m;
}

}  // namespace

ZoneMap::ZoneMap(const MapView& map, const HullGeometry& geometry, std::uint32_t fleet_count, double claim_m)
    : map_(map),
      geometry_(geometry),
      fleet_count_(fleet_count),
      registrars_(1 + fleet_count / kAgvsPerRegistrar),
      grid_(ask<Grid>(
                geometry.parts().facts(),
                [](const fp_facts* facts, std::uint64_t claim_mm, fp_answer* to) {
                  answer(*facts, to, std::vector{work_out(MapView(*facts), static_cast<double>(claim_mm) * 1e-3)});
                },
                static_cast<std::uint64_t>(std::ceil(std::max(claim_m, largest_reach_m(geometry, fleet_count)) * 1e3)))
                .front()) {}

ZoneMap::Grid ZoneMap::work_out(const MapView& map, double claim_m) {
  Vec low_m{INFINITY, INFINITY}, high_m{-INFINITY, -INFINITY};
  for (std::uint32_t id = 0; id < map.station_count(); ++id) {
    const Vec at = map.position_m(id);
    low_m = {std::min(low_m.x, at.x), std::min(low_m.y, at.y)};
    high_m = {std::max(high_m.x, at.x), std::max(high_m.y, at.y)};
  }
  const Vec size_m = high_m - low_m;
  Grid grid;
  grid.low_m = low_m;
  grid.cell_m = std::max(claim_m / kZonesOfClaim, std::max(size_m.x, size_m.y) / (std::sqrt(kMostZones) - 1.0));
  grid.columns = static_cast<std::uint32_t>(size_m.x / grid.cell_m) + 1;
  grid.rows = static_cast<std::uint32_t>(size_m.y / grid.cell_m) + 1;
  return grid;
}

bool ZoneMap::add_zones(std::uint32_t agv, const Path& path, ZoneSet& zones) const {
  bool all_fit = true;
  geometry_.for_each_box(agv, path, [&](const Box& box) { all_fit = add_zones(box, zones) && all_fit; });
  return all_fit;
}

bool ZoneMap::add_zones_around(std::uint32_t agv, std::uint32_t station, ZoneSet& zones) const {
  const HullParts& parts = geometry_.parts();
  bool all_fit = add_zones(parts.box(parts.of_turn(agv, station)), zones);
  const auto add = [&](std::uint32_t lane) {
    all_fit = add_zones(parts.box(parts.of_lane(agv, lane)), zones) && all_fit;
  };
  std::ranges::for_each(map_.lanes_from(station), add);
  std::ranges::for_each(map_.lanes_to(station), add);
  return all_fit;
}

// What lies beyond the stations belongs to the zones at the border.
std::uint32_t ZoneMap::index_of(double cells, std::uint32_t count) {
  return static_cast<std::uint32_t>(std::clamp(cells, 0.0, static_cast<double>(count - 1)));
}

// Of two hulls that come within the clearance of each other, boxes wider by half of it overlap.
bool ZoneMap::add_zones(const Box& box, ZoneSet& zones) const {
  const double wider_m = geometry_.clearance_m() / 2.0 + kZoneRounding_m, per_m = 1.0 / grid_.cell_m;
  const Vec margin{wider_m, wider_m};
  const Vec low = (box.low_m - margin - grid_.low_m) * per_m, high = (box.high_m + margin - grid_.low_m) * per_m;
  const std::uint32_t last_column = index_of(high.x, grid_.columns), last_row = index_of(high.y, grid_.rows);
  bool all_fit = true;
  for (std::uint32_t row = index_of(low.y, grid_.rows); row <= last_row; ++row) {
    for (std::uint32_t column = index_of(low.x, grid_.columns); column <= last_column; ++column)
      all_fit = zones.add(static_cast<std::uint16_t>(row * grid_.columns + column)) && all_fit;
  }
  return all_fit;
}

}  // namespace fleetproof::agents
