#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/formats/read_choice.hpp"

namespace fleetproof {

// The lengths that the file gives for its paths; an empty one: it gives none, or none that can be read.
using StoredLengths = std::vector<std::optional<double>>;

// Whether a stored length is that of the geometry, to 2 % and the millimetre to which files round it.
bool fits(double stored_m, double length_m);

// A plant model can give each point two positions: one in the plant, one in the drawing. Control points belong to the
// drawing. Curves that mix the two are nonsense.
//
// Requires: the stations have the positions of the plant. If the drawing has the same positions (to 1 mm), nothing
// happens. If it has others, one set is taken for all stations, by what the file shows:
// * A model with curves takes the drawing. It keeps the plant if the curves become much shorter that way.
// * A model without curves keeps the plant. It takes the drawing if two stations of a segment are on one spot in the
//   plant and apart in the drawing, and no more stored lengths fit the plant than the drawing.
// * If a station on a segment has no position in the drawing, all keep the plant. Other stations keep theirs.
// A wish of the user comes before what the file shows; then stations without a position in the drawing keep theirs.
//
// `stored_m` is by segment. Returns a sentence that says which positions were taken, and why; empty if there was no
// choice.
std::string settle_positions(Layout& layout, const std::map<std::string, Vec2>& drawn_m, const StoredLengths& stored_m,
                             Positions wish = Positions::ByFile);

// What becomes of stations on one spot, which a straight segment without length joins: one station.
struct JoinedSpots {
  std::vector<StationId> station;               // by station of before: the one that it is now
  std::vector<std::size_t> stations, segments;  // those of before that are left
  std::string sentence;                         // names what was joined; empty if nothing was
};

// Makes one station of stations on one spot if a straight segment leads from one to the other, and its stored length is
// none, too. The station has the name of the first and the purposes of all. If they ask for several headings, it has
// none. Such segments are left out.
JoinedSpots join_spots(Layout& layout, const StoredLengths& stored_m);

// The first straight segment that has no length, although the file says one; empty if there is none.
std::optional<std::size_t> spot_with_length(const Layout& layout, const StoredLengths& stored_m);

// A sentence on the curves that lead far away from their stations, which suggests that their control points belong to
// other coordinates; empty if there are none.
std::string detours_of(const Layout& layout);

}  // namespace fleetproof
