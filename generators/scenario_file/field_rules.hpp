#pragma once

#include <vector>

#include "core/scenario/faults.hpp"
#include "core/scenario/field.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

// Rules between two fields of one struct; the bounds of each field stand in the lists of fields. A fault names a field
// by its key, or a recorded message as "trace/7". Fields beyond their bounds or not a number are not judged here.
std::vector<FieldFault> rule_faults(const RadioSetup& radio);
std::vector<FieldFault> rule_faults(const OperatorSetup& help);

}  // namespace fleetproof
