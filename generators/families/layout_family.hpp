#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/base/catalogue.hpp"
#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/plant.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// Draws a layout that is strongly connected.
//
// Range::Normal leaves room for the default vehicle type (1.6 m x 1.0 m) to turn at every station: stations are at
// least 2.1 m apart. A place to wait (a station to park, charge or store at) is at least 2.2 m from every lane that
// does not end there. That is room for a loaded AGV too: half the diagonal plus half the width of the largest body may
// be 2.1 m. A body of 1.9 m x 1.2 m needs 1.73 m.
//
// Range::Stress gives up that room. Stations are at least 0.9 m apart. Lanes may cross without a station, run side by
// side at 1.2 m and be shorter than a vehicle. An AGV that waits may block any lane. There are two places of storage.
//
// The family `plant` keeps neither promise of room: its stops are 0.5 to 1.5 m apart, in the aisles.
using MakeLayout = Layout (*)(Draws& draws, Range range);

std::span<const Entry<MakeLayout>> layout_families();

// A family and its range.
struct FamilyRange {
  const Entry<MakeLayout>* family;
  Range range;
  // Of the family `plant` only:
  std::uint32_t stations = 0;  // 0: as many as the fleet needs
  std::optional<Provocation> provocation{};
};

// Reads "aisle-grid" or "aisle-grid/stress"; of plants also "plant/2000", "plant/tight-gap" and "plant/stress/2000".
// Throws InputError with a hint if there is no such family, range, size or provocation.
FamilyRange family_range(std::string_view name);

// Says so if a plant of this size, or for this fleet, cannot contain what its name asks for; else empty.
std::string too_small(const FamilyRange& choice, std::uint32_t fleet_size);

// Draws a layout of a family and range. Under stress, one layout in ten has no open place to wait (waiting_room.hpp),
// on purpose; every other layout has at least one. The search for open places needs the map: draw_map() returns it, so
// that the caller does not build it again. The size of a plant without a size follows from `fleet_size`.
std::shared_ptr<const LogicalMap> draw_map(FamilyRange choice, Draws& draws, std::uint32_t fleet_size = 5);
Layout draw_layout(FamilyRange choice, Draws& draws);

// Throws InputError with a hint if there is no such family.
const Entry<MakeLayout>& layout_family(std::string_view name);

}  // namespace fleetproof
