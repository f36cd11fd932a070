#pragma once

#include <string>

#include "storage/records.hpp"

namespace fleetproof {

// Figures of a gate as pages write them: a share in percent, or a rate per AGV-hour.

// `rounded` is one of rounding.hpp.
std::string value_text(const GateRecord& gate, double value, std::string (*rounded)(double));
// "[0 %, 12.1 %]", rounded outwards.
std::string interval_text(const GateRecord& gate, double lower, double upper);
std::string limit_text(const GateRecord& gate);  // with all its digits
// "380 worlds". `unit` is the word for a unit of the gate.
std::string amount_text(std::uint64_t units, std::string_view unit);

}  // namespace fleetproof
