#pragma once

#include <string>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// The layout as tables that parse_csv_layout reads. Reading it gives the same layout, with three exceptions: the name
// becomes the name of the file, the floor is fitted again, and twins become one segment unless the reader keeps them. A
// layout without segments cannot be read again.
std::string to_csv(const Layout& layout);

}  // namespace fleetproof
