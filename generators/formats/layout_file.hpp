#pragma once

#include <string>
#include <string_view>

#include "core/scenario/layout.hpp"

namespace fleetproof {

class JsonReader;
class JsonWriter;

// A layout as JSON, in metres: {"version": 1, "layout": {...}}. Throws InputError with file, line, field, value and
// remedy, also if the layout cannot become a LogicalMap.
Layout read_layout(const std::string& path);
Layout parse_layout(std::string_view text, std::string_view source);

// The layout inside a scenario file (generators/scenario_file). Nothing else of the file is read.
Layout read_layout_of_scenario(const std::string& path);

// The canonical text: a fixed order of keys, and the shortest decimals that read back as the same doubles. Parsing and
// writing it again gives the same text.
std::string to_text(const Layout& layout);

// The inner object, as scenario files embed it. Purposes are a list of "routing", "storage", "charging", "parking".
Layout read_layout(const JsonReader& reader);
void write_layout(JsonWriter& writer, const Layout& layout);

}  // namespace fleetproof
