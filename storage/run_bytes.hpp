#pragma once

#include <string>
#include <string_view>

#include "storage/records.hpp"

namespace fleetproof {

// A run with its recording, as bytes that depend on nothing else.
std::string encode(const RunRecord& run);
// Throws EngineError on bytes that `encode` did not write.
RunRecord decode_run(std::string_view bytes);

}  // namespace fleetproof
