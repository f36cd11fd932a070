#pragma once

#include <string>

#include "storage/records.hpp"

namespace fleetproof {

// Figures of a gate as pages write them: a share in percent, or a rate per AGV-hour.

// `rounded` is one of rounding.hpp. A rate that may be any number has no bound: "none".
std::string value_text(const GateRecord& gate, double value, std::string (*rounded)(double));
// "[0.31, 1.2]" per AGV-hour, rounded outwards; "[0.31, no upper bound]".
std::string rates_text(double lower, double upper);
// "[0 %, 12.1 %]", rounded outwards; "[0.31, 1.2] per AGV-hour".
std::string interval_text(const GateRecord& gate, double lower, double upper);
std::string limit_text(const GateRecord& gate);  // with all its digits
// "380 worlds". `unit` is the word for a unit of the gate.
std::string amount_text(std::uint64_t units, std::string_view unit);

}  // namespace fleetproof
