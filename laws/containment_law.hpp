#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// A load is in exactly one place. The law keeps its own books, from the trace records of orders, picks, drops and
// loads. It accuses a load
// - that passes from one AGV to another, or that a loaded AGV takes;
// - that moves although no AGV picks or drops it at its place, or that is nowhere after a pick or drop;
// - that lies at a station which its transport does not name, for as long as it lies there;
// - that is delivered twice.
// Instants are exact to the nanosecond. The law does not see a load that moves without a record, and it cannot
// distinguish two equal loads.
std::unique_ptr<Law> make_containment_law(const Scenario& scenario);

}  // namespace fleetproof
