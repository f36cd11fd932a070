#include "reports/evidence/gate_words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "reports/evidence/rounding.hpp"

namespace fleetproof {

std::string value_text(const GateRecord& gate, double value, std::string (*rounded)(double)) {
  if (std::isinf(value)) return "none";
  return gate.unit == GateUnit::AgvHour ? rounded(value) + " per AGV-hour" : rounded(100.0 * value) + " %";
}

std::string rates_text(double lower, double upper) {
  return fmt::format("[{}, {}]", rounded_down(lower), std::isinf(upper) ? "no upper bound" : rounded_up(upper));
}

std::string interval_text(const GateRecord& gate, double lower, double upper) {
  if (gate.unit == GateUnit::AgvHour) return rates_text(lower, upper) + " per AGV-hour";
  return fmt::format("[{}, {}]", value_text(gate, lower, rounded_down), value_text(gate, upper, rounded_up));
}

std::string limit_text(const GateRecord& gate) {
  return gate.unit == GateUnit::AgvHour ? fmt::format("{:g} per AGV-hour", gate.limit)
                                        : fmt::format("{:g} %", 100.0 * gate.limit);
}

std::string amount_text(std::uint64_t units, std::string_view unit) { return fmt::format("{} {}", units, unit); }

}  // namespace fleetproof
