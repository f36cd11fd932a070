// Layouts as tables in CSV: reading and writing them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"
#include "generators/map/antiparallel.hpp"

namespace fleetproof {

// Reads a layout from one file of comma-separated values: a table of nodes, then a table of edges. A line with the
// names of the columns stands before each table.
//
//   id,x,y,purposes
//   dock,0,0,storage parking
//   fork,4.5,0,
//   from,to,bidirectional
//   dock,fork,true
//
// A table of the layout, layout,low_x,low_y,high_x,high_y, may stand first: its name, and the corners of its floor.
// Without it, the file's name is the name, and the floor lies 3 m around everything.
// Columns come in any order. Lengths are in metres. These columns may be left out:
// - `purposes`: words, separated by blanks. Empty: routing. The word none: no purpose.
// - `bidirectional`: true, false, 1 or 0, or TRUE and FALSE as a spreadsheet writes them. Empty: false.
// - `name` of an edge. Empty: "dock-fork".
// - `control_points`: x y x y ... Empty: straight.
// - `speed_limit_mps`, `back_speed_limit_mps` (of the other direction), `width_m`. Empty: none, or not known.
// - `turning` and `heading` of a node: as `bidirectional`, but empty is true; a direction x y.
// - `travel`, `back_travel` of an edge: forward, backward or either.
// - `permissions` of an edge: TYPE:any|TYPE:loaded. `blocks`: NAME:one-vehicle|NAME:same-direction. In a name, a bar or
//   backslash stands after a backslash.
// A table of blocks, block,kind, may stand before the edges: blocks without edges have no other place.
// A field with a comma or a double quote stands in double quotes. Empty lines and lines that begin with # are skipped.
//
// Throws InputError with file, line, field, value and remedy if no AGV can drive on the layout. Nothing is left
// out or guessed; `warnings` receives a sentence on twins that were merged.
Layout read_csv_layout(const std::string& path, std::vector<std::string>& warnings, TwinPaths twins = TwinPaths::Merge);
Layout parse_csv_layout(std::string_view text, std::string_view source, std::vector<std::string>& warnings,
                        TwinPaths twins = TwinPaths::Merge);

// The word for a node without any purpose.
inline constexpr std::string_view kNoPurpose = "none";

// The layout as tables that parse_csv_layout reads. Reading it gives the same layout, but a layout without a name is
// named after the file, and twins become one segment unless the reader keeps them. A layout without segments cannot be
// read again.
std::string to_csv(const Layout& layout);

}  // namespace fleetproof
