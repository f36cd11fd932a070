// The layout families: what each of them draws in its two ranges, and the table of all.
#pragma once

#include "generators/families/layout_family.hpp"

namespace fleetproof {

// Aisles between two or three cross aisles; storage bays are short spurs off the aisles, so that a picking AGV does not
// block the aisle. Stress: one cross aisle, and aisles that end dead.
Layout make_aisle_grid(Draws& draws, Range range);

// A corridor with one two-way lane. AGVs let others pass on parallel sidings. On this layout, AGVs easily block each
// other. Stress: 60-100 m with one siding or none.
Layout make_corridor_sidings(Draws& draws, Range range);

// A one-way loop with rounded corners, and spurs on both sides. An AGV that stands on the loop stops all AGVs behind
// it. Stress: about half of the spurs have 0.9-1.5 m. They are shorter than a vehicle, so that it extends into the
// loop. Chords cross the loop and each other without a station.
Layout make_loop_spurs(Draws& draws, Range range);

// Stations at random places. A Gabriel graph joins them; some edges are left out, and directions are drawn. Only the
// strongly connected part is kept. Lanes meet at all angles, and a place to wait may lie in the middle of the traffic.
// Stress: 30-60 % of the edges are left out. Lanes are added close to others, with angles below 30 degrees, or in
// parallel at 1.2-1.5 m.
Layout make_random_planar(Draws& draws, Range range);

// Two diagonal cross aisles that rise from the middle of the front. Picking aisles above them are vertical, picking
// aisles below them are horizontal (Gue and Meller). An AGV that picks blocks its aisle. Stress: diagonals of 20-30 or
// 60-70 degrees, stations at least 2.1 m apart, every aisle two-way.
Layout make_fishbone(Draws& draws, Range range);

// A grid of one-way lines, with spurs at its edge. The grid is so narrow that an AGV on one crossing is next to AGVs on
// all neighbouring crossings. Stress: lines 1-2 vehicle lengths apart, and a second grid over the first. Their lanes
// cross at places without a station.
Layout make_dense_crossing(Draws& draws, Range range);

// A ring of two lanes side by side. Each bar stands on one of them and ends beside the other one, which bends and kinks
// there. AGVs turn in the bars, back into them, or back out of them. Stress: the end of a bar is as far from the
// lane as a body of some size needs that passes, or less; bars are as near to each other as two bodies.
Layout make_close_pass(Draws& draws, Range range);

// The name, what `fleetproof list layouts` says, and the function.
inline constexpr Entry<MakeLayout> kLayoutFamilies[] = {
    {"aisle-grid",
     "4-6 aisles between 2-3 cross aisles, one-way or two-way, with storage bays, docks, parking and chargers; 49-83 "
     "segments",
     make_aisle_grid},
    {"corridor-sidings",
     "one two-way lane of 30-60 m with sidings to let other AGVs pass, and storage spurs; 17-39 segments",
     make_corridor_sidings},
    {"loop-spurs",
     "a one-way loop of 60-200 m with Bezier bends and 8-30 spurs of 3.5-6 m: no AGV can overtake another; 20-87 "
     "segments",
     make_loop_spurs},
    {"random-planar",
     "16-34 stations at random places, lanes at all angles and 4-9 m long, 40-100 % two-way; places to wait lie in "
     "the middle of the traffic",
     make_random_planar},
    {"fishbone",
     "two diagonal cross aisles of 30-60 degrees with picking aisles above and below; an AGV that picks blocks its "
     "aisle",
     make_fishbone},
    {"dense-crossing",
     "3-6 x 3-6 one-way lines 2.4-4 m apart: segments shorter than usual, traffic at every crossing; 10-24 spurs at "
     "the edge",
     make_dense_crossing},
    {"close-pass",
     "a one-way ring of two lanes that bend and kink, with 8-14 bars that end beside the lane across, entered and left "
     "with either end first; 22-48 segments",
     make_close_pass},
    {"plant",
     "zones of aisles inside rings of two one-way lanes, with docks, buffer lanes and charger rows; 20-10000 stations, "
     "as in plant/2000, else 40 for each AGV and at most 5000; more of one thing, as in plant/tight-gap: crossing, "
     "curve-beside-lane, tight-gap, overhang-pass, bottleneck, four-way, back-in",
     make_plant},
};

}  // namespace fleetproof
