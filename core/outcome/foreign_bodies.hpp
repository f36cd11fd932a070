#pragma once

#include <vector>

#include "core/outcome/outcome.hpp"

namespace fleetproof {

// Fallen loads and obstacles. Bodies are numbered AGVs first, then these.
bool is_foreign(EntityId body, const Outcome& outcome);

// By violation of the run: whether the fleet's software answers for it. It does not answer for a violation with a
// foreign body, which it is never told of, nor for one with an AGV that hit such a body and still touches it. An AGV
// that drives on, or that the operator has taken away, is like any other.
std::vector<bool> answerable(const Outcome& outcome);

// Whether a fallen load or an obstacle lay on the floor within the time of the incident. Why an AGV stood or waited is
// then not known.
bool foreign_body_lay(const Outcome& outcome, const Incident& incident);

// Whether any such body lay in the way of the fleet, or was hit.
bool met_foreign_bodies(const Outcome& outcome);

}  // namespace fleetproof
