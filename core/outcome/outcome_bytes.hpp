#pragma once

#include <cstdint>

#include "core/base/byte_text.hpp"
#include "core/outcome/outcome.hpp"

namespace fleetproof {

// Puts the encoding of an outcome (outcome.hpp) behind what stands in `to`.
void encode(const Outcome& outcome, ByteSink& to, std::uint32_t version);

}  // namespace fleetproof
