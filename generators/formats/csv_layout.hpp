#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// Reads a layout from one file of comma-separated values: a table of nodes, then one of edges, each under a line that
// names its columns.
//
//   id,x,y,purposes
//   dock,0,0,storage parking
//   fork,4.5,0,
//   from,to,bidirectional
//   dock,fork,true
//
// Columns come in any order. `purposes` (blanks between words; nothing: routing; the word none: no purpose at all),
// `bidirectional` (true, false, 1, 0; none: false), `name` of an edge (none: "dock-fork") and `control_points` (x y x y
// ...; none: straight) may be left out. Metres. Fields with a comma or a double quote stand in double quotes. Lines
// that are empty or begin with # are skipped.
//
// InputError with file, line, field, value and remedy where the layout cannot be driven on. No warnings: nothing is
// left out or guessed.
Layout read_csv_layout(const std::string& path, std::vector<std::string>& warnings);
Layout parse_csv_layout(std::string_view text, std::string_view source, std::vector<std::string>& warnings);

// The layout in that form. Reading it gives the same layout again, but for its name, which is that of the file, and for
// the floor, which is fitted anew. A layout without segments is not read again.
std::string to_csv(const Layout& layout);

}  // namespace fleetproof
