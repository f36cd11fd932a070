#pragma once

#include <cstdint>
#include <optional>

#include "core/base/random.hpp"
#include "core/base/words.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// What a plant can be asked to contain. The coverage law counts under the same name when a run meets it.
enum class Provocation : std::uint8_t {
  Crossing,
  CurveBesideLane,
  TightGap,
  OverhangPass,
  Bottleneck,
  FourWay,
  BackIn
};
constexpr const char* name_of(Provocation provocation) {
  switch (provocation) {
    case Provocation::Crossing:
      return "crossing";
    case Provocation::CurveBesideLane:
      return "curve-beside-lane";
    case Provocation::TightGap:
      return "tight-gap";
    case Provocation::OverhangPass:
      return "overhang-pass";
    case Provocation::Bottleneck:
      return "bottleneck";
    case Provocation::FourWay:
      return "four-way";
    case Provocation::BackIn:
      return "back-in";
  }
  return kNoWord;
}

inline constexpr std::uint32_t kFewestStations = 20, kMostStations = 10'000;
// The fewest stations of a plant that can contain it.
std::uint32_t fewest_stations(Provocation provocation);
// A plant that belongs to a fleet has so many stations for each AGV, but at least the fewest, and at most so many.
inline constexpr std::uint32_t kStationsPerAgv = 40, kMostStationsOfFleet = 5000;

struct PlantWish {
  Range range = Range::Normal;
  std::uint32_t stations = 5 * kStationsPerAgv;  // kFewestStations .. kMostStations
  std::optional<Provocation> provocation;        // the normal range with this one knob turned
};

// Plant size for a fleet.
std::uint32_t plant_stations(std::uint32_t fleet_size);

// Draws a plant: zones of storage aisles inside a ring of two one-way lanes, with docks, buffer lanes and charger rows
// outside the ring, and corridors between the zones. It has `wish.stations` stations, to 10 %. Strongly connected by
// construction: both lanes of a ring are circles, every mouth of an aisle leads to the inner lane and back, and one of
// each zone at least leads to the outer lane and back. Plants below 80 stations have one lane.
Layout make_plant(Draws& draws, const PlantWish& wish);
Layout make_plant(Draws& draws, Range range);

}  // namespace fleetproof
