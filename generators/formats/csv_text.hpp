#pragma once

#include <string>

#include "core/scenario/layout.hpp"

namespace fleetproof {

// The layout as tables that parse_csv_layout reads. Reading it gives the same layout, but a layout without a name is
// named after the file, and twins become one segment unless the reader keeps them. A layout without segments cannot be
// read again.
std::string to_csv(const Layout& layout);

}  // namespace fleetproof
