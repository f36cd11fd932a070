#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "reports/evidence/confidence.hpp"
#include "reports/evidence/hourly_rate.hpp"
#include "storage/records.hpp"

namespace fleetproof {

// The decisions of a gate of the method any-time, as whole numbers: release_gate.hpp says when it passes,
// refutation.hpp when it is refuted. `cells` of the gate: if each is judged for itself (unit Run), they share the risk
// of a wrong refutation. The table ends after 256 failures, or, from 16 failures on, where more need 16 times the
// planned replicates; with more failures than that, a gate passes and is refuted in proportion to the last row. Empty
// for the method Fixed.
GateTable gate_table(const GateRecord& gate, const GateCells& cells, std::uint64_t planned_replicates);

// The smallest number of units that meets the limit after so many failures; none if there is no such number.
std::optional<std::uint64_t> passes_from(const GateTable& table, std::uint64_t failing);
bool passes(const GateTable& table, std::uint64_t failing, std::uint64_t units);
bool refutes(const GateTable& table, std::uint64_t failing, std::uint64_t units);

}  // namespace fleetproof
