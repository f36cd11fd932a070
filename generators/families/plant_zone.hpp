// A zone of a plant: its aisles, the ring around it, and what it has more of.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/random.hpp"
#include "generators/families/layout_builder.hpp"
#include "generators/families/plant.hpp"

namespace fleetproof {

inline constexpr std::int64_t kPlantVehicleWidth_mm = 1'000;

// What is drawn of a plant before it is built. Lengths in millimetres.
struct PlantKnobs {
  std::int64_t lane_gap = 0;       // between vehicles 1.0 m wide on the two lanes of a ring, or in a passing bay
  std::int64_t side_gap = 0;       // the same between the outer lane and a buffer lane or charger row
  std::int64_t corner_radius = 0;  // of the inner lane
  std::int64_t mouth_radius = 0;   // from the nearer lane into an aisle or corridor
  std::int64_t stop_pitch = 0;     // between stops in an aisle or buffer lane
  std::int64_t aisle_rest = 0;     // between the outermost stations of two mouths side by side
  std::int64_t corridor = 0;       // length
  bool all_mouths_cross = false;   // else one in three: its curves cross the nearer lane to join the farther one
  bool bottleneck = false;         // one corridor between two zones, and one way only through the plant; else two
  bool four_way = false;           // a cross aisle meets every aisle at a station
  bool side_lanes_everywhere = false;
  bool back_in = false;  // AGVs back into docks and chargers, and leave them nose first

  std::int64_t lane_pitch() const { return kPlantVehicleWidth_mm + lane_gap; }
  std::int64_t side_pitch() const { return kPlantVehicleWidth_mm + side_gap; }
};

PlantKnobs draw_plant_knobs(Draws& draws, const PlantWish& wish);

// Lengths in millimetres. The size is that of the inner lane, as if its corners were sharp.
struct RingShape {
  std::int64_t width = 0, height = 0, corner_radius = 0, lane_pitch = 0;
  bool has_outer_lane = true;
};

// The main aisle round a zone: an inner lane that runs clockwise and an outer one that runs counter-clockwise, so that
// traffic keeps to the right. Sides are counted counter-clockwise from the south; a place on a side is its distance
// from the corner where the side begins, in that direction.
class PlantRing {
 public:
  enum Side : std::uint8_t { South, East, North, West };
  enum class Facing : std::uint8_t { Inside, Outside };

  // `low` is the corner of South and West. Requires: the builder outlives the ring.
  PlantRing(LayoutBuilder& builder, std::string name, PointMm low, const RingShape& shape);

  std::int64_t length(Side side) const { return side % 2 == 0 ? shape_.width : shape_.height; }
  // A point beside the inner lane; `outwards` is negative within the ring.
  PointMm point(Side side, std::int64_t place, std::int64_t outwards) const;
  std::int64_t outer_line() const { return shape_.has_outer_lane ? shape_.lane_pitch : 0; }

  // The station on the lane that is nearer to the outside; made if it is not there.
  StationId outermost(Side side, std::int64_t place) { return on_lane(outermost_lane(), side, place); }

  // A station in front of which curves lead from the nearer lane in and out, and with `crosses` from the other lane as
  // well: these cross the nearer lane at places without a station.
  StationId mouth(Side side, std::int64_t place, Facing facing, std::int64_t radius, bool crosses);

  // Connects the stations of both lanes, with more of them where a length is long. Call it once, after everything that
  // adds stations.
  void connect();

 private:
  enum Lane : std::uint8_t { Inner, Outer };
  Lane outermost_lane() const { return shape_.has_outer_lane ? Outer : Inner; }
  std::int64_t outwards(Lane lane) const { return lane == Outer ? shape_.lane_pitch : 0; }
  StationId on_lane(Lane lane, Side side, std::int64_t place);
  void join(Lane lane, Side side, std::int64_t place, std::int64_t reach, StationId mouth);
  void connect(Lane lane);
  void divide(Lane lane, Side side);

  LayoutBuilder& builder_;
  std::string name_;
  PointMm low_;
  RingShape shape_;
  std::array<std::array<std::map<std::int64_t, StationId>, 4>, 2> stations_;  // by lane, side and place
};

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
