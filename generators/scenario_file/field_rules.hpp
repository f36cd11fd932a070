#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario/faults.hpp"
#include "core/scenario/field.hpp"
#include "core/scenario/radio_setup.hpp"

namespace fleetproof {

constexpr std::uint32_t kAgvNumbers = 65536;  // from 0 on: those that files may name
// The longest recording of a radio and the longest delay in it; runs have the same limit.
constexpr Duration kLongestRadioTime = std::chrono::seconds(1'000'000'000);

// Rules between two fields of one struct. The bounds of each field are in the lists of fields. A fault names a field by
// its key, or a recorded message as "trace/7". A field that is out of bounds or not a number is not judged here.
std::vector<FieldFault> rule_faults(const RadioSetup& radio);
std::vector<FieldFault> rule_faults(const OperatorSetup& help);

}  // namespace fleetproof
