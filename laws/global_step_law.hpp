#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// The baseline of the paper (Sect. 5.2): at every step of every drive activity, one check with every other entity. It
// needs 38 400 checks on Fig. 4; the paper's law needs 4 020.
std::unique_ptr<Law> make_global_step_law(const Scenario& scenario);

}  // namespace fleetproof
