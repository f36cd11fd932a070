#pragma once

#include <cstdint>

#include "core/agents/hull.hpp"
#include "core/agents/map_view.hpp"
#include "core/agents/path.hpp"
#include "core/agents/zone_set.hpp"

namespace fleetproof::agents {

// The floor as square zones, the same for all AGVs of a fleet. Two hulls that conflict have a zone in common. For each
// zone one AGV of the fleet keeps the roll of those that are there or mean to go there: its registrar.
class ZoneMap {
 public:
  // `claim_m`: the length of the longest claim. A claim, and the body of an AGV, cover fewer zones than a ZoneSet has
  // room for. Requires: the geometry outlives the object.
  ZoneMap(const MapView& map, const HullGeometry& geometry, std::uint32_t fleet_count, double claim_m);

  std::uint32_t zone_count() const { return grid_.columns * grid_.rows; }
  // Adds the zones of a hull. False if the set is full; then some are missing.
  bool add_zones(std::uint32_t agv, const Path& path, ZoneSet& zones) const;
  // Adds the zones of all lanes that begin or end at a station, and of turning there.
  bool add_zones_around(std::uint32_t agv, std::uint32_t station, ZoneSet& zones) const;

  std::uint32_t registrar_count() const { return registrars_; }
  std::uint32_t registrar(std::uint32_t index) const { return index * fleet_count_ / registrars_; }
  std::uint32_t registrar_of(std::uint16_t zone) const { return registrar(zone * registrars_ / zone_count()); }

 private:
  struct Grid {
    Vec low_m;
    double cell_m = 1.0;
    std::uint32_t columns = 1, rows = 1;
  };
  static Grid work_out(const MapView& map, double claim_m);

  bool add_zones(const Box& box, ZoneSet& zones) const;
  static std::uint32_t index_of(double cells, std::uint32_t count);

  const MapView& map_;
  const HullGeometry& geometry_;
  std::uint32_t fleet_count_, registrars_;
  Grid grid_;
};

}  // namespace fleetproof::agents
