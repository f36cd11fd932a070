#pragma once

#include <string>
#include <string_view>

namespace fleetproof {

// FIPS 180-4 SHA-256 of some bytes, as 64 hex digits.
std::string sha256_hex(std::string_view bytes);

}  // namespace fleetproof
