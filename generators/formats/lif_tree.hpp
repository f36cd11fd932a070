#pragma once

#include <string_view>

#include "generators/text/json_value.hpp"

namespace fleetproof {

// The JSON text of a LIF file. A key whose value is null is taken out: programs write it where they have no value. Keys
// that LIF asks for stay, so that they are refused where they are read.
JsonValue parse_lif_tree(std::string_view text, std::string_view source);

}  // namespace fleetproof
