#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// The paper's baseline (Sect. 5.2): at every step of every drive activity, one check with each other entity, wherever
// and whatever it is. It needs 38 400 checks on Fig. 4 where the paper's law needs 4 020.
std::unique_ptr<Law> make_global_step_law(const Scenario& scenario);

}  // namespace fleetproof
