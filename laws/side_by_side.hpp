#pragma once

#include "laws/encounter.hpp"

namespace fleetproof {

inline constexpr double kTightGap_m = 0.12;
inline constexpr double kBesideACurve_m = 0.3;

// How two drives pass each other on floor that both do not need. The band of a track is as wide as its body; bodies
// reach beyond it in a bend. Judged at points 0.4 m apart along the tracks, each 1 micrometre in favour of a meeting.
struct SideBySide {
  // The bands run along each other, to 10 degrees, with a gap of 0 to 0.12 m between them.
  bool tight_gap = false;
  // A drive in a bend comes within 0.3 m of the body of the other one.
  bool curve_beside_lane = false;
  // The bands keep `margin_m`, but the bodies come closer to each other, because one of them drives a bend.
  bool overhang_pass = false;
};

// Nothing is met if the bands overlap somewhere: then the tracks cross, merge or are one track.
SideBySide side_by_side(const Track& a, const Track& b, double margin_m);
// True only if side_by_side() finds nothing between two straight tracks: they run in different directions, or one ends
// within the band of the other. `widths_m`: half their widths.
bool surely_not_side_by_side(const MiddleLine& a, const MiddleLine& b, double widths_m);

}  // namespace fleetproof
