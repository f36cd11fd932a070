#pragma once

#include <string>
#include <string_view>

#include "core/scenario/layout.hpp"

namespace fleetproof {

class JsonReader;
class JsonWriter;

// A layout as JSON: {"version": 1, "layout": {...}}; metres. InputError with file, line, field, value and remedy, also
// where the layout could not become a LogicalMap.
Layout read_layout(const std::string& path);
Layout parse_layout(std::string_view text, std::string_view source);

// Canonical: fixed order of keys, shortest decimals that read back to the same doubles. parse_layout of it gives the
// same text again.
std::string to_text(const Layout& layout);

// The inner object, as scenario files embed it. Purposes are a list of "routing", "storage", "charging", "parking".
Layout read_layout(const JsonReader& reader);
void write_layout(JsonWriter& writer, const Layout& layout);

}  // namespace fleetproof
