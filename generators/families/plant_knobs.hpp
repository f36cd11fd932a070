#pragma once

#include <cstdint>

#include "core/base/random.hpp"
#include "generators/families/plant.hpp"

namespace fleetproof {

inline constexpr std::int64_t kPlantVehicleWidth_mm = 1'000;

// What is drawn of a plant before it is built. Lengths in millimetres.
struct PlantKnobs {
  std::int64_t lane_gap = 0;       // between vehicles 1.0 m wide on the two lanes of a ring, or in a passing bay
  std::int64_t side_gap = 0;       // likewise between the outer lane and a buffer lane or charger row
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

}  // namespace fleetproof
