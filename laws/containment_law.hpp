#pragma once

#include <memory>

#include "core/outcome/law.hpp"

namespace fleetproof {

// A load is in exactly one place. Keeps books of its own, from what the trace records of orders, picks, drops and
// loads, and accuses a load that passes from one AGV to another, that a full AGV takes, that moves without an AGV
// picking or dropping it at its place, that is nowhere after a pick or drop, that lies at a station which its transport
// does not name (for as long as it lies there), or that is delivered twice. To the nanosecond. It does not see a load
// that moves without a record, nor which of two equal loads is meant.
std::unique_ptr<Law> make_containment_law(const Scenario& scenario);

}  // namespace fleetproof
