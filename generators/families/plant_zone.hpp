#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "generators/families/plant_knobs.hpp"
#include "generators/families/plant_ring.hpp"

namespace fleetproof {

// What all zones of a plant share. Lengths in millimetres. Aisles lie in slots side by side. One slot may be free of
// them: there, a corridor leads to the zones above and below.
struct ZoneShape {
  std::uint32_t slots = 1;
  std::int64_t free_slot = -1;  // -1: none
  bool has_outer_lane = true, has_bays = true;
  std::uint32_t most_stops = 0;  // of a half aisle

  std::int64_t lane_pitch(const PlantKnobs& knobs) const { return has_outer_lane ? knobs.lane_pitch() : 0; }
  std::int64_t slot_pitch(const PlantKnobs& k) const { return 2 * (k.mouth_radius + lane_pitch(k)) + k.aisle_rest; }
  std::int64_t slot_place(const PlantKnobs& k, std::int64_t slot) const {
    return k.corner_radius + (slot + 1) * slot_pitch(k);
  }
  std::int64_t width(const PlantKnobs& k) const { return 2 * k.corner_radius + (slots + 1) * slot_pitch(k); }
  // Where the cross aisle runs and corridors begin, from the southern side of the ring.
  std::int64_t middle(const PlantKnobs& k) const;
  std::int64_t height(const PlantKnobs& k) const;
};

// One zone of a plant: aisles within a ring, docks to the south of it, charger rows and buffer lanes to the north.
class PlantZone {
 public:
  // `low` is the corner of the ring. Requires: builder, draws, knobs and shape outlive the zone.
  PlantZone(LayoutBuilder& builder, Draws& draws, const PlantKnobs& knobs, const ZoneShape& shape, std::string name,
            PointMm low);

  // Builds all but the corridors. `stops` is by half aisle.
  void build(const std::vector<std::uint32_t>& stops);

  // The station at which a corridor begins; `aside` is its distance from the middle of the side.
  StationId corridor(PlantRing::Side side, std::int64_t aside, bool crosses);
  void finish() { ring_.connect(); }

 private:
  std::vector<std::int64_t> aisle_slots() const;
  void aisle(std::int64_t slot, bool crosses, std::uint32_t low_stops, std::uint32_t high_stops);
  StationId bay(StationId from, std::int64_t slot, std::int64_t begin);
  StationId next(StationId from, PointMm at, Purposes purposes, std::string_view letter);
  void cross_aisle();
  void spurs();
  void spur(StationId from, PointMm end, Purposes purposes, std::string_view letter);
  void spur_of_ring(PlantRing::Side side, std::int64_t place, Purposes purposes, std::string_view letter);
  void side_lanes();
  void side_lane(std::int64_t first_gap, std::int64_t gaps, bool charges);

  LayoutBuilder& builder_;
  Draws& draws_;
  const PlantKnobs& knobs_;
  const ZoneShape& shape_;
  std::string name_;
  PointMm low_;
  PlantRing ring_;
  std::vector<StationId> middles_;  // of the aisles, west to east, if there is a cross aisle
  std::uint32_t numbered_ = 0;      // stations that are not on the ring
};

}  // namespace fleetproof
