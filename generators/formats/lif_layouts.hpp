#pragma once

#include <set>
#include <string>

#include "generators/text/json_value.hpp"

namespace fleetproof {

struct ChosenLayout {
  JsonReader layout;
  std::set<std::string> elsewhere{};  // ids of the nodes of the other layouts
  std::string sentence{};             // begins with file and line; empty if there was no choice
};

// The layout of a LIF file with this layoutId, or if there is none with this layoutLevelId, among the layouts of the
// file and of all its origins. An empty `wanted` is the layout of a file that has one. Throws InputError that lists the
// layouts if none or several match.
ChosenLayout choose_layout(const JsonReader& root, const std::string& wanted);

}  // namespace fleetproof
