#pragma once

#include <span>

#include "core/catalogue.hpp"
#include "core/law.hpp"

namespace fleetproof {

// Every law there is, the default first.
std::span<const Entry<MakeLaw>> laws();

}  // namespace fleetproof
