#pragma once

#include <string>
#include <string_view>

namespace fleetproof {

// FIPS 180-4 SHA-256 of some bytes, as 64 hex digits.
std::string sha256_hex(std::string_view bytes);

// The same of a whole file. Throws MachineError if it cannot be read.
std::string sha256_of_file(const std::string& path);

}  // namespace fleetproof
