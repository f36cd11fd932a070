#pragma once

#include <cstdint>

namespace fleetproof {

// Calls of operator new in this program so far.
std::uint64_t allocations();

}  // namespace fleetproof
