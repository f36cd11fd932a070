#pragma once

#include <string>

#include "core/scenario/layout.hpp"

namespace fleetproof::cli {

// Writes a layout to the file of --output: LIF if it ends in .lif.json, with a warning for what LIF has no place for;
// tables if it ends in .csv; else JSON. Without a name: JSON on standard output.
void put_layout(const Layout& layout, const std::string& path);

// What --output says about this.
inline constexpr const char* kLayoutOutputHelp =
    "write to this file instead of standard output: LIF if it ends in .lif.json, tables if in .csv, else JSON";

}  // namespace fleetproof::cli
