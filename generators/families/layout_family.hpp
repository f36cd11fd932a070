#pragma once

#include <memory>
#include <span>

#include "core/base/catalogue.hpp"
#include "core/base/random.hpp"
#include "core/scenario/layout.hpp"
#include "generators/families/range.hpp"

namespace fleetproof {

// Invents a layout: strongly connected, and in the normal range with room for the default vehicle type (1.6 m x 1.0 m)
// to turn at every station. There stations are at least 2.1 m apart; one where an AGV may wait (parking, charging,
// storage) is at least 2.2 m from every lane of which it is no end. Stress gives up that room: stations are at least
// 0.9 m apart, lanes may cross without a station, run side by side at 1.2 m and be shorter than a vehicle; what waits
// may close any of them. Still strongly connected, with two places of storage.
using MakeLayout = Layout (*)(Draws& draws, Range range);

std::span<const Entry<MakeLayout>> layout_families();

// A family and how far it goes.
struct FamilyRange {
  const Entry<MakeLayout>* family;
  Range range;
};

// "aisle-grid" or "aisle-grid/stress". InputError with a hint if there is no such family or range.
FamilyRange family_range(std::string_view name);

// Draws a layout. Of those under stress one in ten has no place to wait but where it cuts off others
// (waiting_room.hpp), on purpose; each of the others has one at least. The map is built for that anyway: who needs it
// spares building it again.
std::shared_ptr<const LogicalMap> draw_map(FamilyRange choice, Draws& draws);
Layout draw_layout(FamilyRange choice, Draws& draws);

// InputError with a hint if there is no such family.
const Entry<MakeLayout>& layout_family(std::string_view name);

}  // namespace fleetproof
